"""The signs of a run: a handful of physical quantities in each of its stages; and the place where two runs part.

A stage goes from one lift-off to the next. The first tick is one of its own: all runs of a scenario begin it in the
same state, so that what one does differently there is its controller's doing alone.
"""

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import partial

import numpy as np

from surefoot.planner.geometry.plane import frame_rotation, headings
from surefoot.planner.types import GRAVITY
from surefoot.scenarios.columns import Reads
from surefoot.scenarios.judge.body import leg
from surefoot.scenarios.judge.digest import CONTROL_TOPICS, GAIT, Array, RunView, Window
from surefoot.scenarios.judge.feet import stance_slips
from surefoot.scenarios.judge.walking import runs_of
from surefoot.scenarios.log import Log
from surefoot.scenarios.show.logview import FOOT_NAMES, LOADED

LONGEST_LAG = 10
"""Lags that are tried [ticks]."""

ALIKE = 0.5
"""Share of the planned changes, squared, that may be left of them when the measured ones are taken off [-]."""

LEAST_CHANGE = 0.01
"""Change of the planned forces from tick to tick, RMS, below which no lag can be measured [N]."""


@dataclass(frozen=True, slots=True)
class Stage:
    """A stretch of a run.

    Attributes:
        label: its name: first tick, stand, step 1 and so on.
        begin: its first tick.
        end: the tick after its last.
        foot: that swings: 0 left, 1 right, -1 none.
        landed: tick at which its swing is over.
    """

    label: str
    begin: int
    end: int
    foot: int = -1
    landed: int = 0

    @property
    def ticks(self) -> slice:
        """All of it."""
        return slice(self.begin, self.end)


def stages(run: RunView) -> list[Stage]:
    """The stages of a run in order, none of them empty."""
    if not run.ticks:
        return []
    stance = run.field(GAIT, "stance")
    swings = sorted((*swing, foot) for foot in (0, 1) for swing in runs_of(run.single_support & (stance == 1 - foot)))
    ends = [*(begin for begin, _, _ in swings), run.ticks]
    steps = [
        Stage(f"step {number}", begin, ends[number], foot, min(landed, run.ticks - 1))
        for number, (begin, landed, foot) in enumerate(swings, 1)
    ]
    return [one for one in (Stage("first tick", 0, 1), Stage("stand", 1, ends[0]), *steps) if one.end > one.begin]


Measure = Callable[[RunView, Sequence[Stage]], Array]
"""From a run and its stages to values, shape (stages, columns); NaN where they mean nothing."""


@dataclass(frozen=True, slots=True)
class Sign:
    """Something that distinguishes runs, a number for each stage, or a place.

    Attributes:
        columns: names; three are the x, y and z of a place in the world.
        digits: behind the point.
        tolerance: how far two runs may be apart that count as the same, and share of the value beside it.
        unit: in which a person is shown it.
        figure: of `surefoot plot` that shows it.
        words: what it is, of which foot and in which stage.
        measure: it.
        body: whether it is of joints and real feet, which a pendulum has not got.
        peak: whether it parts only above the greatest value of all stages.
        planned: whether it is held against a plan.
    """

    columns: tuple[str, ...]
    digits: int
    tolerance: tuple[float, float]
    unit: str
    figure: str
    words: str
    measure: Measure
    body: bool = False
    peak: bool = False
    planned: bool = False

    @property
    def scale(self) -> float:
        """From its values to what a person is shown."""
        return {"ms": 1e3, "mm": 1e3, "deg": 180.0 / math.pi}.get(self.unit, 1.0)


def _times(run: RunView, parts: Sequence[Stage]) -> Array:
    return run.time[[one.begin for one in parts], None]


def _landings(run: RunView, parts: Sequence[Stage]) -> Array:
    """Places where the soles truly were when their swings were over; none where none has swung."""
    rows = [np.full(3, np.nan) if one.foot < 0 else run.sole(one.foot)[one.landed, :3] for one in parts]
    return np.array(rows).reshape(-1, 3)


def _landing_yaw(run: RunView, parts: Sequence[Stage]) -> Array:
    poses = [run.sole(max(one.foot, 0))[one.landed if one.foot >= 0 else one.begin] for one in parts]
    return headings(np.array(poses).reshape(-1, 7)[:, 3:])[:, None]


def _swing_error(run: RunView, parts: Sequence[Stage]) -> Array:
    """Greatest distance of the swing sole in each stage from its reference."""
    planned, found = run.field("/reference", "swing_position"), np.full((len(parts), 1), np.nan)
    for row, one in enumerate(parts):
        swing = slice(one.begin, one.landed)
        if one.foot >= 0 and one.landed > one.begin:
            found[row] = np.linalg.norm(run.sole(one.foot)[swing, :3] - planned[swing], axis=1).max()
    return found


def _each(series: Callable[[RunView], Array], reduced: Callable[[Array], float] = np.max) -> Measure:
    """A number for each stage of a series over the control ticks, by default its greatest value."""

    def measure(run: RunView, parts: Sequence[Stage]) -> Array:
        values = series(run)
        return np.array([[reduced(values[one.ticks])] for one in parts])

    return measure


def _leg_torque(run: RunView, side: str) -> Array:
    """Mean square of the torques that the joints of a leg are commanded."""
    joints = leg(run.constants.joint_names, run.constants.roles, side)
    return np.asarray(np.mean(run.field("/torque", "command")[:, joints] ** 2, axis=1))


def _friction(run: RunView, side: str) -> Array:
    """Force along the ground over the normal force that the controller plans, where the foot is loaded."""
    wrench = run.field("/wbc", f"wrench_{side}")
    loaded = wrench[:, 2] > LOADED * run.constants.mass * GRAVITY
    return np.where(loaded, np.hypot(wrench[:, 0], wrench[:, 1]) / np.where(loaded, wrench[:, 2], 1.0), 0.0)


def _moment(run: RunView, side: str) -> Array:
    """Square of the moment that the ground gives a sole about its centre, as measured."""
    return np.asarray(np.sum(run.field("/measurement", f"wrench_{side}")[:, 3:] ** 2, axis=1))


def _slip(run: RunView, parts: Sequence[Stage], foot: int) -> Array:
    """Greatest way of a foot on the ground in each stage, from where its stance began."""
    way = np.full(run.ticks, np.nan)
    for slip in stance_slips(run):
        if slip.foot == foot:
            way[slip.ticks] = slip.way
    return np.array([[np.fmax.reduce(way[one.ticks])] for one in parts])


def _lag(run: RunView, parts: Sequence[Stage]) -> Array:
    """Time by which the measured normal forces follow the planned ones: where their changes differ least.

    Measured while the robot shifts its weight before the first step; touchdowns shake the forces more than a lag does.
    """
    planned, felt = (
        np.diff(np.column_stack([run.field(topic, f"wrench_{side}")[:, 2] for side in FOOT_NAMES]), axis=0)
        for topic in ("/wbc", "/measurement")
    )
    found = np.full((len(parts), 1), np.nan)
    for row, one in enumerate(parts):
        asked, given = planned[one.ticks][:-LONGEST_LAG], felt[one.ticks]
        size = float(np.mean(asked**2)) if len(asked) > LONGEST_LAG else 0.0
        if one.foot < 0 and size > LEAST_CHANGE**2:
            apart = [np.mean((asked - given[lag : lag + len(asked)]) ** 2) for lag in range(LONGEST_LAG)]
            if min(apart) < ALIKE * size:
                found[row] = int(np.argmin(apart)) / run.constants.control_rate
    return found


def _zmp_error(run: RunView) -> Array:
    """Distance of the measured ZMP from the one that the footsteps define; none in flight."""
    error = np.linalg.norm(run.field("/contact", "zmp")[:, :2] - run.field("/reference", "zmp_reference"), axis=1)
    return np.where(np.isfinite(error), error, 0.0)


def _sway(run: RunView) -> Array:
    """Distance of the CoM along the ground from the one that the controller was asked for."""
    return np.asarray(np.linalg.norm((run.field("/truth", "com") - run.field("/reference", "com"))[:, :2], axis=1))


def _com(run: RunView, parts: Sequence[Stage]) -> Array:
    return run.field("/truth", "com")[[one.end - 1 for one in parts]]


_TILT: Callable[[RunView], Array] = lambda run: run.field("/truth", "torso_tilt")  # noqa: E731
_LAG = "lag of the measured ground forces behind those that the controller plans {stage}"
_SWING = "swing task: largest distance of the {foot} sole from its reference {stage}"
_BALANCE = "balance: largest distance of the CoM along the ground from where the controller was to hold it {stage}"
_ZMP = "largest distance of the ZMP from its reference {stage}"
_SOLE, _YAW = "{foot} sole at touchdown of {label}", "heading of the {foot} sole at touchdown of {label}"


def _leg(side: str) -> Sign:
    torque = _each(partial(_leg_torque, side=side), lambda squared: math.sqrt(np.mean(squared)))
    words = f"torque of the {side} leg (RMS) {{stage}}"
    return Sign((f"torque_{side}",), 2, (0.5, 0.02), "N m", "torques", words, torque, body=True)


def _grip(side: str) -> Sign:
    used = _each(partial(_friction, side=side))
    words = f"largest force along the ground over normal force that the controller plans for the {side} foot {{stage}}"
    return Sign((f"friction_{side}",), 3, (0.1, 0.0), "", "grip", words, used, body=True, peak=True, planned=True)


def _pressed(side: str) -> Sign:
    moment = _each(partial(_moment, side=side), lambda squared: math.sqrt(np.mean(squared)))
    words = f"moment of the ground on the {side} sole about its centre (RMS) {{stage}}"
    return Sign((f"moment_{side}",), 3, (0.05, 0.01), "N m", "soles", words, moment, body=True)


def _slid(foot: int) -> Sign:
    side = FOOT_NAMES[foot]
    words = f"largest way of the {side} foot on the ground {{stage}}"
    return Sign((f"slip_{side}",), 5, (2e-4, 0.05), "mm", "feet", words, partial(_slip, foot=foot), body=True)


SIGNS: tuple[Sign, ...] = (
    Sign(("time",), 3, (0.011, 0.0), "s", "feet", "begin of {label}", _times),
    Sign(("lag",), 4, (1e-3, 0.0), "ms", "feet", _LAG, _lag, body=True, planned=True),
    *map(_grip, FOOT_NAMES),
    Sign(("sole_x", "sole_y", "sole_z"), 4, (1e-3, 0.0), "mm", "soles", _SOLE, _landings),
    Sign(("sole_yaw",), 4, (5e-3, 0.0), "deg", "top-view", _YAW, _landing_yaw),
    Sign(("swing",), 5, (5e-5, 0.05), "mm", "feet", _SWING, _swing_error, planned=True),
    *map(_slid, (0, 1)),
    *map(_leg, FOOT_NAMES),
    Sign(("zmp",), 4, (5e-3, 0.05), "mm", "balance", _ZMP, _each(_zmp_error), planned=True),
    Sign(("sway",), 5, (2e-4, 0.05), "mm", "balance", _BALANCE, _each(_sway), planned=True),
    Sign(("tilt",), 4, (2e-3, 0.05), "deg", "balance", "largest tilt of the torso {stage}", _each(_TILT), body=True),
    *map(_pressed, FOOT_NAMES),
    Sign(("com_x", "com_y", "com_z"), 4, (2e-3, 0.0), "mm", "balance", "CoM at the end of {label}", _com),
)
"""Signs of a run; of those that part in the same stage, the first is nearest to the cause.

Torques come late: after the first tick they follow from how the robot moves.
"""

COLUMNS = tuple(column for sign in SIGNS for column in sign.columns)

FAR, _LOST = 10.0, 2.0
"""Tolerances by which a run may be better than its baseline: one that is farther off says that something else than the
walk has changed, its judge for instance; and how far off a value counts that cannot be measured any more [-]."""

_SIDES = (("ahead of", "behind"), ("to the left of", "to the right of"), ("above", "below"))


@dataclass(frozen=True, slots=True)
class Parting:
    """Something in which a run is not as its baseline.

    Attributes:
        text: what, where and by how much, in a sentence without a full stop.
        stage: number of the stage.
        excess: how far they are apart over how far they may be [-].
        figure: of `surefoot plot` that shows it.
        begin: of the stage [s].
        end: of the stage [s]; infinite for the last one.
    """

    text: str
    stage: int
    excess: float
    figure: str
    begin: float
    end: float


_WRENCHES = tuple(f"wrench_{side}" for side in FOOT_NAMES)
_READS: Reads = {
    **dict.fromkeys(CONTROL_TOPICS, ()),
    GAIT: ("phase", "stance"),
    "/truth": ("com", "torso_tilt", "left_sole", "right_sole"),
    "/reference": ("com", "phase", "stance", "swing_position", "zmp_reference"),
    "/measurement": _WRENCHES,
    "/contact": ("zmp", "normal_force", "planned", "active"),
    "/wbc": _WRENCHES,
    "/torque": ("command",),
}
"""Fields of which the signs are made, read in one pass."""


def _applies(sign: Sign, walker: str) -> bool:
    """Return true if runs of a kind of walker have a sign."""
    return not (sign.body and walker == "pendulum") and not (sign.planned and walker == "seat")


@dataclass(frozen=True, slots=True)
class Trace:
    """The signs of a run.

    Attributes:
        labels: of its stages.
        feet: that swing in them: left, right or both, which none does.
        values: by column, each of shape (stages,), NaN where one means nothing.
    """

    labels: tuple[str, ...]
    feet: tuple[str, ...]
    values: Mapping[str, Array]

    @classmethod
    def of(cls, log: Log) -> "Trace":
        """The signs of a log, as far as it has what they need."""
        run = RunView(Window(log, log.gather(_READS)))
        parts = stages(run)
        values: dict[str, Array] = {}
        for sign in SIGNS if parts else ():
            if _applies(sign, run.constants.walker):
                values |= dict(zip(sign.columns, sign.measure(run, parts).T, strict=True))
        return cls(tuple(one.label for one in parts), tuple((*FOOT_NAMES, "both")[one.foot] for one in parts), values)

    def partings(self, now: "Trace") -> list[Parting]:
        """Everything in which a run is not as this one, stage by stage, in each in the order of the signs."""
        longest = max(len(self.labels), len(now.labels))
        return [parting for stage in range(longest) for parting in self._partings(now, stage)]

    def _partings(self, now: "Trace", stage: int) -> list[Parting]:
        longer = self if len(self.labels) > stage else now
        begin, *later = longer._begins[stage:]
        window = (begin, min(later, default=math.inf))
        if min(len(self.labels), len(now.labels)) <= stage:
            text = f"{longer.labels[stage]} is {'not there' if longer is self else 'one too many'}"
            return [Parting(text, stage, math.inf, "balance", *window)]
        if (self.labels[stage], self.feet[stage]) != (now.labels[stage], now.feet[stage]):
            which = (f"{one.labels[stage]} with the foot {one.feet[stage]}" for one in (now, self))
            return [Parting(" is in the baseline ".join(which), stage, math.inf, "feet", *window)]
        distances = ((sign, self._apart(now, sign, stage)) for sign in SIGNS)
        return [Parting(text, stage, far, sign.figure, *window) for sign, (far, text) in distances if not far <= 1.0]

    @property
    def _begins(self) -> list[float]:
        return self.values["time"].tolist() if "time" in self.values else [0.0] * len(self.labels)

    def _apart(self, now: "Trace", sign: Sign, stage: int) -> tuple[float, str]:
        """Distance of a sign from its value before, over the allowed one, and that in words."""
        before, after = (self._at(sign, stage), now._at(sign, stage))
        known = np.isfinite(before), np.isfinite(after)
        if not np.any(known) or not self.values.keys() >= set(sign.columns):
            return 0.0, ""
        label, foot = self.labels[stage], self.feet[stage]
        where = {"first tick": "at the first tick", "stand": "before the first step"}.get(label, f"in {label}")
        what = sign.words.format(stage=where, label=label, foot=foot)
        if not np.all(known):
            since = "cannot be told any more" if known[0].all() else "could not be told in the baseline"
            return _LOST, f"{what} {since}"
        yaw = self.values["sole_yaw"][stage] if len(before) == 3 and "sole_yaw" in self.values else 0.0
        if sign.peak:
            before = np.array([np.nanmax(self.values[sign.columns[0]])])
            off = self._over_peak(now, sign, stage, float(before[0]))
        else:
            off = after - before
        if sign.unit == "deg":
            off = np.remainder(off + math.pi, 2.0 * math.pi) - math.pi
        allowed = sign.tolerance[0] + sign.tolerance[1] * float(np.abs(before).max())
        text = _place_text(off, yaw, sign) if len(off) == 3 else _number_text(after, before, sign)
        return float(np.linalg.norm(off)) / allowed, f"{what}: {text}"

    def _over_peak(self, now: "Trace", sign: Sign, stage: int, peak: float) -> Array:
        """Distance of a value above the greatest of all stages; in that one's stage, the run's lack, if it is far."""
        (column,), tolerance = sign.columns, sign.tolerance[0] + sign.tolerance[1] * abs(peak)
        below = peak - float(np.nanmax(now.values[column]))
        if self.values[column][stage] == peak and below > FAR * tolerance:
            return np.array([-below])
        return np.maximum(now.values[column][[stage]] - peak, 0.0)

    def _at(self, sign: Sign, stage: int) -> Array:
        return np.array([self.values[name][stage] if name in self.values else math.nan for name in sign.columns])


def _place_text(off: Array, yaw: float, sign: Sign) -> str:
    """Distance of one place from another, in words, along the direction of the greatest part in the heading there."""
    along = (*(off[:2] @ frame_rotation(yaw)), off[2])
    axis = int(np.argmax(np.abs(along)))
    return f"{sign.scale * abs(along[axis]):.1f} {sign.unit} {_SIDES[axis][int(along[axis] < 0.0)]} the baseline"


def _number_text(now: Array, before: Array, sign: Sign) -> str:
    values = (f"{sign.scale * float(one[0]):.3g} {sign.unit}".rstrip() for one in (now, before))
    return f"{next(values)}, {'at most ' if sign.peak else ''}{next(values)} in the baseline"
