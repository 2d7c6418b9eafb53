"""A small robot as URDF text, whose every length is known, with whatever is to be wrong with it."""

from dataclasses import dataclass, field

HIP, THIGH, SHANK, ANKLE = 0.08, 0.3, 0.28, 0.06
FOOT = (0.18, 0.08, 0.02)
AHEAD = 0.03
"""Centre of the sole ahead of the ankle."""

AXES = {"x": "1 0 0", "y": "0 1 0", "z": "0 0 1", "-y": "0 -1 0", "-x": "-1 0 0"}


@dataclass
class Biped:
    """The parts of a biped that may be altered.

    Attributes:
        knee: axis of the knees; bent forward, their angles are positive about y.
        shoulder: axis of the shoulders.
        turned: whether x of the base points backward.
        feet: whether the feet have shapes.
        arms: whether it has arms.
        beside: how far outside the axis of its roll joint a leg is.
        extra: more links and joints.
        changes: text that is put in the place of other text at the end.
    """

    knee: str = "y"
    shoulder: str = "y"
    turned: bool = False
    feet: bool = True
    arms: bool = True
    beside: float = 0.0
    extra: str = ""
    changes: dict[str, str] = field(default_factory=dict)

    def urdf(self) -> str:
        """The whole text."""
        ahead = -0.02 if self.turned else 0.02
        parts = [_link("base", 8.0, (0.15, 0.2, 0.1), (ahead, 0, 0.03))]
        for side, sign in (("left", 1), ("right", -1)):
            parts += self._leg(side, sign)
            parts += self._arm(side, sign) if self.arms else []
        text = f'<robot name="biped">{"".join(parts)}{self.extra}</robot>'
        for old, new in self.changes.items():
            assert old in text, old
            text = text.replace(old, new)
        return text

    def _leg(self, side: str, sign: int) -> list[str]:
        at = (0, HIP * sign * (-1 if self.turned else 1), 0)
        turn = "0 0 3.141592653589793" if self.turned else "0 0 0"
        knee = (0.0, 2.0) if self.knee == "y" else (-2.0, 0.0)
        box = (*FOOT[:2], FOOT[2])
        foot = (AHEAD, 0.0, FOOT[2] / 2 - ANKLE) if self.feet else None
        return [
            _joint(f"{side}_yaw", "base", f"{side}_yaw_link", at, "z", rpy=turn),
            _link(f"{side}_yaw_link", 0.5, (0.05, 0.05, 0.05), shape=False),
            _joint(f"{side}_roll", f"{side}_yaw_link", f"{side}_roll_link", (0, 0, 0), "x"),
            _link(f"{side}_roll_link", 0.5, (0.05, 0.05, 0.05), shape=False),
            _joint(f"{side}_pitch", f"{side}_roll_link", f"{side}_thigh", (0, self.beside * sign, 0), "y"),
            _link(f"{side}_thigh", 2.0, (0.06, 0.06, 0.2), (0, 0, -THIGH / 2)),
            _joint(f"{side}_knee", f"{side}_thigh", f"{side}_shank", (0, 0, -THIGH), self.knee, knee),
            _link(f"{side}_shank", 1.5, (0.05, 0.05, 0.2), (0, 0, -SHANK / 2)),
            _joint(f"{side}_ankle_pitch", f"{side}_shank", f"{side}_ankle", (0, 0, -SHANK), "y"),
            _link(f"{side}_ankle", 0.2, (0.03, 0.03, 0.03), shape=False),
            _joint(f"{side}_ankle_roll", f"{side}_ankle", f"{side}_foot", (0, 0, 0), "x"),
            _link(f"{side}_foot", 0.6, box, foot or (0, 0, 0), shape=foot is not None),
        ]

    def _arm(self, side: str, sign: int) -> list[str]:
        at = (0, 0.16 * sign * (-1 if self.turned else 1), 0.3)
        turn = "0 0 3.141592653589793" if self.turned else "0 0 0"
        return [
            _joint(f"{side}_shoulder", "base", f"{side}_arm", at, self.shoulder, (-2.5, 2.5), rpy=turn),
            _link(f"{side}_arm", 1.0, (0.05, 0.05, 0.2), (0, 0, -0.12)),
            _joint(f"{side}_elbow", f"{side}_arm", f"{side}_forearm", (0, 0, -0.25), "y", (-2.0, 0.5)),
            _link(f"{side}_forearm", 0.6, (0.04, 0.04, 0.15), (0, 0, -0.1)),
        ]


def _link(name, mass, size, at=(0, 0, 0), shape=True) -> str:
    a, b, c = (mass / 12 * (size[i] ** 2 + size[j] ** 2) for i, j in ((1, 2), (0, 2), (0, 1)))
    origin = f'<origin xyz="{_text(at)}"/>'
    box = f'<geometry><box size="{_text(size)}"/></geometry>'
    shapes = f"<visual>{origin}{box}</visual><collision>{origin}{box}</collision>" if shape else ""
    inertia = f'<inertia ixx="{a}" iyy="{b}" izz="{c}" ixy="0" ixz="0" iyz="0"/>'
    return f'<link name="{name}"><inertial>{origin}<mass value="{mass}"/>{inertia}</inertial>{shapes}</link>'


def _joint(name, parent, child, at, axis, limits=(-1.2, 1.2), rpy="0 0 0") -> str:
    return (
        f'<joint name="{name}" type="revolute"><parent link="{parent}"/><child link="{child}"/>'
        f'<origin xyz="{_text(at)}" rpy="{rpy}"/><axis xyz="{AXES[axis]}"/>'
        f'<limit lower="{limits[0]}" upper="{limits[1]}" effort="80" velocity="15"/></joint>'
    )


def _text(values) -> str:
    return " ".join(map(str, values))


NARROW = "sole: {length: 0.18, width: 0.03, centre: [0.03, 0.0, -0.06]}\n"
"""A sole that stands on its side edges rather than flat."""

FILE = "name: biped\nmodel: biped.urdf\nfeet: {left: left_foot, right: right_foot}\n"


def write(folder, biped=None, file=FILE, model="biped.urdf"):
    """Put both files into a folder; returns the robot file."""
    (folder / model).write_text(biped if isinstance(biped, str) else (biped or Biped()).urdf())
    path = folder / "biped.yaml"
    path.write_text(file)
    return path
