"""The drawings of the pages that explain: boxes and arrows, as SVG that needs no program to be drawn.

`make.py` writes them, with the digest of this file in each.
"""

from dataclasses import dataclass
from html import escape

from surefoot.scenarios.palette import BLACK, DARK, GREEN, ORANGE, PURPLE, SKY, WHITE, hexadecimal, paler

WIDTH, BOX_HEIGHT, GAP, MARGIN = 880, 74, 46, 16
"""Sizes of a drawing, a box, the room between rows, and the rim [px]."""

INK, LINE, PAPER = hexadecimal(BLACK), hexadecimal(DARK), hexadecimal(WHITE)
FILLS = tuple(hexadecimal(paler(color, 0.8)) for color in (SKY, ORANGE, GREEN, PURPLE))


@dataclass(frozen=True)
class Drawing:
    """The content of a drawing.

    Attributes:
        title: for who cannot see it.
        rows: boxes from the left to the right, each with a heading and a line below it; rows from the top down. A plus
            stands before the heading of a box that is beside the one on its left, not behind it.
        notes: words beside the arrow below each row but the last.
        back: words beside the arrow from the last row to the first; none without.
    """

    title: str
    rows: tuple[tuple[tuple[str, str], ...], ...]
    notes: tuple[str, ...]
    back: str = ""

    def svg(self, digest: str) -> str:
        """Its text, with the digest of what it follows from."""
        height = 2 * MARGIN + len(self.rows) * BOX_HEIGHT + (len(self.rows) - 1) * GAP
        parts = [*self._rows(), *(self._back(height) if self.back else ())]
        head = f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {height}" role="img"'
        style = f'font-family="system-ui, sans-serif" fill="{INK}"'
        tip = f'<path d="M0 0 L8 4 L0 8 z" fill="{LINE}"/>'
        size = 'markerWidth="8" markerHeight="8" refX="7" refY="4" orient="auto"'
        marker = f'<defs><marker id="tip" {size}>{tip}</marker></defs>'
        paper = f'<rect width="{WIDTH}" height="{height}" rx="8" fill="{PAPER}"/>'
        lines = [f"<!-- sources: {digest} -->", f"{head} {style}>", f"<title>{escape(self.title)}</title>", marker]
        return "\n".join([*lines, paper, *parts, "</svg>", ""])

    @property
    def _room(self) -> float:
        return WIDTH - 2 * MARGIN - (150 if self.back else 0)

    def _rows(self) -> list[str]:
        parts, y = [], MARGIN
        for index, row in enumerate(self.rows):
            wide = (self._room - 28 * (len(row) - 1)) / len(row)
            for column, (heading, line) in enumerate(row):
                x = MARGIN + column * (wide + 28)
                parts += _box(x, y, wide, heading.removeprefix("+ "), line, FILLS[index % len(FILLS)])
                if column and not heading.startswith("+ "):
                    parts.append(_arrow(f"M{x - 26:.0f} {y + BOX_HEIGHT / 2:.0f} h24"))
            if index < len(self.rows) - 1:
                middle = MARGIN + self._room / 2
                parts.append(_arrow(f"M{middle:.0f} {y + BOX_HEIGHT + 2} v{GAP - 5}"))
                parts.append(_text(middle + 12, y + BOX_HEIGHT + GAP / 2 + 4, self.notes[index], 14, "start"))
            y += BOX_HEIGHT + GAP
        return parts

    def _back(self, height: int) -> list[str]:
        right, first, last = MARGIN + self._room, MARGIN + BOX_HEIGHT / 2, height - MARGIN - BOX_HEIGHT / 2
        path = f"M{right:.0f} {last:.0f} h36 V{first:.0f} h-34"
        words = self.back.split(" / ")
        middle = 0.5 * (first + last) - 9 * (len(words) - 1)
        told = [_text(right + 46, middle + 18 * line, text, 14, "start") for line, text in enumerate(words)]
        return [_arrow(path), *told]


def _box(x: float, y: float, wide: float, heading: str, line: str, fill: str) -> list[str]:
    size = f'x="{x:.0f}" y="{y}" width="{wide:.0f}" height="{BOX_HEIGHT}" rx="6"'
    frame = f'<rect {size} fill="{fill}" stroke="{LINE}"/>'
    middle = x + wide / 2
    return [frame, _text(middle, y + 31, heading, 17, "middle", "600"), _text(middle, y + 54, line, 14, "middle")]


def _text(x: float, y: float, text: str, size: int, anchor: str, weight: str = "400") -> str:
    look = f'font-size="{size}" font-weight="{weight}" text-anchor="{anchor}"'
    return f'<text x="{x:.0f}" y="{y:.0f}" {look}>{escape(text)}</text>'


def _arrow(path: str) -> str:
    return f'<path d="{path}" fill="none" stroke="{LINE}" stroke-width="1.6" marker-end="url(#tip)"/>'


DRAWINGS = {
    "tick.svg": Drawing(
        "A tick of the closed loop: sensors, estimator, planner, controller, physics and log",
        (
            (("sensors", "joints, IMU, feet"), ("estimator", "state of the body")),
            (("planner, 50 Hz", "CoM, ZMP, footsteps"), ("reference", "sampled in between")),
            (("controller, 500 Hz", "a QP of the whole body"), ("motors", "joint torques")),
            (("physics, 1 kHz", "MuJoCo"), ("log", "every arrow is a channel")),
        ),
        ("CoM and feet; joints and base", "CoM, ZMP, DCM, swing foot, contacts", "torques"),
        "the next tick",
    ),
    "planner.svg": Drawing(
        "A plan: footsteps, ZMP reference and CoM height make a model; a QP gives the jerk of the CoM",
        (
            (("footsteps", "gait, commands, recovery"),),
            (("ZMP reference", "eq. (12)"), ("+ CoM height", "eq. (15)")),
            (("model of the jerk", "eqs. (2) to (6), (10), (11)"), ("+ bounds", "eqs. (8), (9), (14)")),
            (("QP: least cost", "eq. (7)"), ("plan", "CoM, ZMP, DCM, feet")),
        ),
        ("where and when feet stand", "what is wanted over the horizon", "matrices, of which one row varies with time"),
        "CoM, feet / and DCM, / eq. (13)",
    ),
    "qp.svg": Drawing(
        "The whole-body QP: tasks and limits make it, its solution becomes torques",
        (
            (("plan", "CoM, feet, contacts"), ("+ robot", "M, h, Jacobians")),
            (("tasks, weighted", "CoM, trunk, feet, posture"), ("+ limits", "wrench cones, joints, torques")),
            (("QP", "accelerations and wrenches"), ("fallbacks", "another solver, then equalities")),
            (("torques", "M q'' + h - J' w"),),
        ),
        ("build", "solve", "interpret"),
        "the state / of the / next tick",
    ),
    "recovery.svg": Drawing(
        "Recovery: a push moves the DCM; sole, then steps, then nothing is left",
        (
            (("push", "moves CoM and DCM"),),
            (("DCM error", "at the next landing"), ("within the sole?", "the ZMP holds it")),
            (("steps moved", "place and time as one program"), ("within reach?", "legs, ground, other foot")),
            (("plan goes on", "the gait comes back"), ("capture margin", "how much is left")),
        ),
        ("measured each plan", "no: more than the sole holds", "the best landing of all times tried"),
        "each plan, / 50 Hz",
    ),
    "estimation.svg": Drawing(
        "Estimation: what sensors say becomes the state and how sure it is",
        (
            (("encoders", "joints"), ("+ IMU", "turning and acceleration"), ("+ feet", "wrenches, or torques")),
            (("joint observer", "angles and velocities"), ("+ contacts", "which foot is loaded")),
            (("Kalman filter", "base, feet, zeros of the encoders"),),
            (("state", "for controller and planner"), ("+ deviation", "widens their limits")),
        ),
        ("late, noisy, with zeros that are wrong", "a loaded foot does not move", "each tick"),
        "what the / controller / decided",
    ),
}
"""Drawings by the name of the file."""
