"""Checks that a log agrees with itself, and that what its scenario asks for acted: commands, places, ground."""

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from surefoot.planner.geometry.plane import headings
from surefoot.scenarios.columns import Reads
from surefoot.scenarios.errors import LogError
from surefoot.scenarios.file.criteria import Bound
from surefoot.scenarios.file.gait import CommandSettings
from surefoot.scenarios.judge.digest import CONTROL_TOPICS, Array, RunView
from surefoot.scenarios.judge.feet import terrain_of
from surefoot.scenarios.judge.walking import fall_time, runs_of
from surefoot.scenarios.record.provenance import END_RECORD

AT_PLACE = 0.02
"""Distance from the place where the robot was commanded to go within which it is there, if no criterion says it [m]."""

AT_HEADING = 0.02
"""Difference from the heading that it was commanded to have there, a little more than a degree [rad]."""

_BEGIN = 0.5
"""Greatest delay of the first tick of a log, whose first states a line may lose [s]."""

_SAME_TIME = 1e-6
"""Times of commands are sums and carry rounding [s]."""


def not_there(metrics: Mapping[str, object], criteria: Mapping[str, Bound], length: float) -> Iterator[str]:
    """Report the way that a robot of a length [-] has not gone, unless a criterion says how far from it it may be."""
    for name, near, unit in (("place_error", AT_PLACE * length, "m"), ("heading_error", AT_HEADING, "rad")):
        error = metrics.get(name)
        if isinstance(error, float) and name not in criteria and error > near:
            what = f"the robot is {error:.3g} {unit} from where it was commanded to go last"
            yield f"{what}; it must be within {near:g} {unit}"
    missed = metrics.get("waypoints_missed")
    if missed and "waypoints_missed" not in criteria:
        yield f"the robot never came to {missed} of its waypoints, with the heading asked for there"


@dataclass(frozen=True, slots=True)
class _Gait:
    """Times of plans and ticks [s], phases (0 stand, 1 double, 2 single), and first and last ticks of the swings."""

    plans: Array
    time: Array
    phase: Array
    swings: list[tuple[int, int]]

    @classmethod
    def of(cls, run: RunView) -> "_Gait":
        return cls(run.log["/plan"].time, run.time, run.field("/reference", "phase"), runs_of(run.single_support))

    def heard(self, command: CommandSettings) -> float:
        """Time of the plan that takes a command, infinite when none does [s]."""
        later = np.flatnonzero(self.plans >= command.time - _SAME_TIME)
        return float(self.plans[later[0]]) if len(later) else math.inf

    def stepping(self, begin: float, end: float) -> bool:
        """Return true if a foot is swung or the weight shifted between two times."""
        return bool(self.phase[(self.time >= begin - _SAME_TIME) & (self.time < end - _SAME_TIME)].any())

    def begun_by(self, time: float) -> int:
        """Steps whose swing is fixed at a time: those begun, and the one to which the weight is being shifted."""
        begun = sum(self.time[first] <= time for first, _ in self.swings)
        here = int(np.searchsorted(self.time, time - _SAME_TIME))
        ahead = np.flatnonzero(self.phase[here:] != 1)
        shifting = len(ahead) and ahead[0] > 0 and self.phase[here + ahead[0]] == 2
        return int(begun) + bool(shifting)


def idle_commands(run: RunView, commands: Sequence[CommandSettings]) -> Iterator[str]:
    """Report the promised commands of a scenario that came to nothing, of those that came in what the log has.

    Where to walk, and how long supports last, acts on a robot that steps before another command supersedes it; a swing
    height on the next step that is not yet begun. One that asks to stand, or for what holds anyway, asks for no change.
    """
    if run.constants.walker == "seat":
        yield from _unheard(run, commands)
    if not commands or not run.has("/plan", "/reference", "/truth"):
        return
    gait = _Gait.of(run)
    order = sorted(range(len(commands)), key=lambda index: commands[index].time)
    for place, index in enumerate(order):
        command, later = commands[index], [commands[other] for other in order[place + 1 :]]
        if not command.live and (run.kept is None or command.time > run.kept.begin):
            yield from _idle(f"commands.{index}", command, [other for other in later if not other.live], gait)


def _unheard(run: RunView, commands: Sequence[CommandSettings]) -> Iterator[str]:
    """Report the promised commands that a controller without a planner has not heard in what the log has."""
    heard, near = run.log["/command"].time if run.has("/command") else np.zeros(0), 1.5 / run.constants.control_rate
    for index, command in enumerate(commands):
        seen = run.kept is None or command.time > run.kept.begin
        if not command.live and seen and not (np.abs(heard - command.time) < near).any():
            yield f"commands.{index} came at {command.time:g} s and never acted: the controller did not hear it"


def _idle(name: str, command: CommandSettings, later: Sequence[CommandSettings], gait: _Gait) -> Iterator[str]:
    begin = gait.heard(command)
    if math.isinf(begin):
        yield f"{name} came at {command.time:g} s and never acted: no plan was made after it"
        return
    for entry in _asked(command):
        until = next((gait.heard(other) for other in later if entry in command.superseded_by(other)), math.inf)
        if until <= begin:
            yield f"{name}.{entry} never acted: another command superseded it before a plan was made"
        elif entry == "swing_height":
            if gait.begun_by(min(until, gait.time[-1])) == gait.begun_by(begin):
                yield f"{name}.{entry} never acted: the robot began no step by it"
        elif not gait.stepping(begin, until):
            yield f"{name}.{entry} never acted: the robot stood for as long as it held"


def _asked(command: CommandSettings) -> Iterator[str]:
    """Keys of what a command wants changed; of a velocity one that is not zero, none when it asks to stand."""
    leading = ("v_x", "v_y", "yaw_rate", "march")
    yield from [name for name in leading if getattr(command, name)][:1]
    for name in ("place", "single_support", "double_support", "swing_height"):
        if getattr(command, name) is not None:
            yield name


READS: Reads = {"/command": ("velocity", "yaw_rate", "followed_velocity", "followed_yaw_rate")}
"""Fields of commands that `bent_commands` compares."""

_AS_ASKED = 1e-3
"""Share of a velocity by which the one that is followed may be another for rounding [-]."""


def bent_commands(run: RunView) -> Iterator[str]:
    """Report the velocities commanded to a walk that were out of reach, and what it did in place of the first."""
    if not run.has("/command"):
        return
    commands = run.log["/command"]
    try:
        asked, followed = (
            np.column_stack([commands.field(f"{kind}velocity"), commands.field(f"{kind}yaw_rate")])
            for kind in ("", "followed_")
        )
    except LogError:  # of a version that did not tell
        return
    away = np.linalg.norm(followed - asked, axis=1) > _AS_ASKED * np.linalg.norm(asked, axis=1)
    rows = np.flatnonzero(away)
    if not len(rows):
        return
    first, given = rows[0], int(np.isfinite(asked).all(axis=1).sum())
    what = f"commanded velocities out of reach, bent to what is not: {len(rows)} of {given}, the first at"
    yield f"{what} {commands.time[first]:.6g} s from {_velocity(asked[first])} to {_velocity(followed[first])}"


def _velocity(values: Array) -> str:
    v_x, v_y, yaw_rate = values
    return f"v_x {v_x:.3g} m/s, v_y {v_y:.3g} m/s, yaw_rate {yaw_rate:.3g} rad/s"


def unmet_ground(run: RunView) -> Iterator[str]:
    """Report ground, not as believed, that no foot came upon, so that it was no test."""
    unforeseen = run.constants.unforeseen
    if not unforeseen or not run.has("/truth", "/contact"):
        return
    soles, later = _stances(run, 0), _stances(run, run.walking.start) if run.walking.stop else np.zeros((0, 3))
    half, ground = 0.5 * np.array([run.constants.foot_length, run.constants.foot_width]), terrain_of(run)
    for key, numbers in unforeseen.items():
        # Noise leaves the ground as it is believed to be where the robot starts; a box may lie there too.
        stances = soles if key.startswith("errors.ground.") else later
        if not any(ground.carries(stances, half, number) for number in numbers):
            yield f"{key} never acted: no foot came upon ground that is not as believed"


def _stances(run: RunView, start: int) -> Array:
    """Places and headings of the soles in the middle of each contact from a tick on, shape (n, 3) [m, m, rad]."""
    felt = run.field("/contact", "felt") != 0
    found = []
    for foot in (0, 1):
        rows = [(begin + end) // 2 for begin, end in runs_of(felt[:, foot]) if begin >= start]
        sole = run.sole(foot)[rows]
        found.append(np.column_stack([sole[:, :2], headings(sole[:, 3:])]))
    return np.concatenate(found)


def contradictions(run: RunView) -> tuple[str, ...]:
    """Report contradictions between the record of a run's end, the clock and the data of a whole log."""
    if not run.has("/truth"):
        return ("the log shows no motion: /truth has no messages",)
    with np.errstate(invalid="ignore", divide="ignore", over="ignore"):
        return (*_clock(run), *_numbers(run), *_end(run))


def _clock(run: RunView) -> Iterator[str]:
    """Every tick has its message on every channel of the control rate, one period after the other."""
    stamps, period = run.log["/truth"].time_ns, 1e9 / run.constants.control_rate
    begin = 0.0 if run.kept is None else run.kept.begin
    if not abs(1e-9 * stamps[0] - begin) < _BEGIN:
        yield f"the data of the log begin at {1e-9 * stamps[0]:.3f} s, and those that it should have at {begin:.3f} s"
    uneven = np.flatnonzero(np.abs(np.diff(stamps) - period) > 1.0)
    if len(uneven):
        yield f"the ticks of the log are not {1e-6 * period:g} ms apart at {1e-9 * stamps[uneven[0]]:.3f} s"
    for topic in CONTROL_TOPICS:
        if topic in run.log and not np.array_equal(run.log[topic].time_ns, stamps):
            yield f"{topic} has not the ticks of /truth"


def _numbers(run: RunView) -> Iterator[str]:
    """A state that is no number is no fall, and no walk either."""
    for name in ("com", "com_velocity"):
        if not np.isfinite(run.field("/truth", name)).all():
            yield f"/truth {name} has values that are not numbers"


def _end(run: RunView) -> Iterator[str]:
    """The record of the end tells the fall that the data show, at its time, or the time at which they end."""
    record, tick = run.log.metadata[END_RECORD], 1.0 / run.constants.control_rate
    try:
        said = float(record["time"])
    except (KeyError, ValueError):
        said = math.nan
    fall = fall_time(run)
    if record["kind"] == "completed":
        if fall is not None:
            yield f"the log says that the run was completed, and its data show a fall at {fall:.3f} s"
        end = run.log["/truth"].time[-1] + tick
        if not abs(end - said) < 1.5 * tick:
            yield f"the log says that the run was completed at {said:.3f} s, and its data end at {end:.3f} s"
    elif fall is None:
        yield f"the log says that the robot fell at {said:.3f} s, and its data show no fall"
    elif not abs(fall - said) < 1.5 * tick:
        yield f"the log says that the robot fell at {said:.3f} s, and its data show a fall at {fall:.3f} s"
