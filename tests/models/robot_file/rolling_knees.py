"""Bipeds whose knees are two hinges that turn as one, as URDF and as MJCF."""

import biped
import mjcf_biped

RATIO = 1.0
GAP = 0.05
"""Distance of the two hinges of a knee of the URDF [m]."""

_ROLLER = (
    '<link name="{side}_roller"><inertial><mass value="0.3"/>'
    '<inertia ixx="1e-3" iyy="1e-3" izz="1e-3" ixy="0" ixz="0" iyz="0"/></inertial></link>'
)


def mimic(of: str, ratio: float = RATIO, offset: float = 0.0) -> str:
    """An element that lets a joint of either side follow another one of that side."""
    return f'<mimic joint="{{side}}_{of}" multiplier="{ratio}" offset="{offset}"/>'


def urdf(second: str = mimic("knee"), first: str = "", limit: str = "", axis: str = "0 1 0") -> str:
    """A biped with a hinge below each knee.

    Args:
        second: what else stands in that hinge; ``{side}`` is left or right.
        first: what else stands in the knee.
        limit: of the hinge; as far as the knee goes, with its torque, unless given.
        axis: of the hinge.
    """
    text = biped.Biped().urdf()
    limit = limit or '<limit lower="-0.1" upper="1.0" effort="60" velocity="12"/>'
    for side in ("left", "right"):
        hinge = f'<joint name="{side}_second" type="revolute">'
        hinge += f'<parent link="{side}_roller"/><child link="{side}_shank"/>'
        hinge += f'<origin xyz="0 0 -{GAP}"/><axis xyz="{axis}"/>{limit}{second.format(side=side)}</joint>'
        child = f'<child link="{side}_shank"/>'
        text = text.replace(child, f'<child link="{side}_roller"/>{first.format(side=side)}', 1)
        text = text.replace("</robot>", f"{_ROLLER.format(side=side)}{hinge}</robot>")
    return text


def equality(polycoef: str = "0 1 0 0 0", follower: str = "second", leader: str = "knee") -> str:
    """Equalities of both knees."""
    rows = [
        f'<joint name="{side}" joint1="{side}_{follower}" joint2="{side}_{leader}" polycoef="{polycoef}"/>'
        for side in ("left", "right")
    ]
    return f"<equality>{''.join(rows)}</equality>"


def motors(of: str = "second", torque: float = 50.0) -> str:
    """A motor for a joint of each side."""
    rows = [f'<motor joint="{side}_{of}" forcerange="-{torque} {torque}"/>' for side in ("left", "right")]
    return f"<actuator>{''.join(rows)}</actuator>"


def mjcf(*more: str, knee: bool = True, armature: float = 0.0) -> str:
    """A biped with two hinges in each shank, 0.05 m one below the other, with no link between them.

    Args:
        more: sections of the document, which stand in it at its end.
        knee: whether the first hinge has its motor, of 160 N·m.
        armature: of the second hinge [kg m^2].
    """
    text = mjcf_biped.TEXT
    for side in ("left", "right"):
        first = f'<joint name="{side}_knee" axis="0 1 0" pos="0.048 0 -0.014" range="0.2 2"/>'
        assert first in text
        second = f'<joint name="{side}_second" axis="0 1 0" pos="0.096 0 -0.028" range="-0.1 1"'
        hinges = f'{first.replace("0.2 2", "0.1 1")}{second} armature="{armature}"/>'
        motor = f'<general joint="{side}_knee" forcerange="-80 80" gear="2"/>'
        text = text.replace(first, hinges).replace(motor, motor if knee else "")
    return text.replace("</mujoco>", "".join(more) + "</mujoco>")
