"""Causes of a fall: actions before balance was lost, and departures from what planner and controller believe.

A cause acted in the half second before balance was lost, or before steps had to catch the body. Such events stand in
the order of time. What is wrong all the time comes after them, the largest departure first. Friction as believed and
sensors as specified are no cause.
"""

from collections.abc import Iterator

import numpy as np

from surefoot.planner.geometry.plane import frame_rotation
from surefoot.scenarios.judge import feet
from surefoot.scenarios.judge.beliefs import SAME_FRICTION, beliefs
from surefoot.scenarios.judge.computing_checks import DRIFT
from surefoot.scenarios.judge.digest import SENSED, Array, RunView
from surefoot.scenarios.judge.finding import Finding, pushes
from surefoot.scenarios.judge.loss import Loss
from surefoot.scenarios.judge.motion_checks import SLIP
from surefoot.scenarios.judge.scenario import scenario_of
from surefoot.scenarios.judge.walking import runs_of

LEAST_PUSH = 0.05
"""Impulse of a push that may fell a robot, an eighth of what one survives in mid-swing [N·s/kg]."""

LEAST_STEP = 0.005
"""Difference of ground from believed height that fells nobody [m]."""

_FAULTS = {
    "torque_loss": "the motors give no torque",
    "planner_freeze": "no new plan is made",
    "state_nan": "the measured state is not a number",
    "qp_failure": "the solver of the whole-body QP fails",
}


def causes(run: RunView, lost: Loss) -> tuple[Finding, ...]:
    """Find the causes of a loss of balance, events in the order of time first; empty where all was as believed.

    Raises:
        LogError: its log holds no scenario that can be read.
    """
    events = (*_pushed(run, lost), *_failed(run, lost), *_slipped(run, lost), *_stepped(run, lost))
    return (*sorted(events, key=lambda one: one.time or 0.0), *_lasting(run, lost))


def _cause(kind: str, time: float | None, value: float, found: str, likely: str = "") -> Finding:
    return Finding(kind, "warning", time, value, found, likely, "cause")


def _pushed(run: RunView, lost: Loss) -> Iterator[Finding]:
    force, size = pushes(run), run.constants.similarity
    period, mass = 1.0 / run.constants.control_rate, run.constants.mass
    least = LEAST_PUSH * size.factor("m/s")
    for start, end in runs_of(np.asarray(force.any(axis=1))):
        # A message tells of the tick before it.
        begin, over = float(run.time[start]) - period, float(run.time[end - 1])
        if not lost.overlaps(begin, over):
            continue
        acted = force[start:end][run.time[start:end] >= lost.since]
        impulse = acted.sum(axis=0) * period / mass
        amount = float(np.linalg.norm(impulse))
        if amount >= least:
            found = f"a push of {amount:.2g} N·s/kg {_way(run, start, impulse)} acts from {begin:.3f} to {over:.3f} s"
            yield _cause("push", max(begin, 0.0), amount, found, _before(lost, begin))


def _before(lost: Loss, time: float) -> str:
    """The delay of the loss of balance after something began, in words."""
    return f"balance is lost {max(lost.time - time, 0.0):.2f} s after it began"


def _way(run: RunView, tick: int, impulse: Array) -> str:
    """Direction of a push, seen from the robot, in words."""
    yaw = np.angle(np.exp(1j * run.sole_yaw[tick]).sum())
    ahead, left = (impulse[:2] @ frame_rotation(float(yaw))).tolist()
    words = [("forward" if ahead > 0.0 else "backward", abs(ahead)), ("left" if left > 0.0 else "right", abs(left))]
    words += [("up" if impulse[2] > 0.0 else "down", abs(float(impulse[2])))]
    most = max(part for _, part in words)
    return "and ".join(f"{word} " for word, part in words if part > 0.5 * most).strip()


def _failed(run: RunView, lost: Loss) -> Iterator[Finding]:
    for fault in scenario_of(run.log).faults:
        end = np.inf if fault.duration is None else fault.time + fault.duration
        if lost.overlaps(fault.time, end):
            found = f"{_FAULTS[fault.kind]} from {fault.time:.3f} s on (faults, {fault.kind})"
            yield _cause("fault", fault.time, 1.0, found, _before(lost, fault.time))


def _slipped(run: RunView, lost: Loss) -> Iterator[Finding]:
    """A foot that slips on ground with less friction than the controller counts on."""
    known = beliefs(run)
    if not known.less_friction or not run.has("/contact", "/reference"):
        return
    most, until = SLIP * run.constants.similarity.length, int(np.searchsorted(run.time, lost.time, "right"))
    begun: list[tuple[float, float]] = []
    acted = False
    for slip in feet.stance_slips(run, until):
        tick = slip.since(most)
        friction = _friction_under(run, slip.foot, tick)
        if slip.distance > most and friction < known.friction[1] - SAME_FRICTION:
            begun.append((float(run.time[tick]), friction))
            acted |= lost.overlaps(begun[-1][0], float(run.time[slip.ticks[-1]]))
    if acted:
        time, friction = min(begun)
        found = f"a foot slips on ground with a friction of {friction:g} from {time:.3f} s on"
        likely = f"the controller counts on {known.friction[1]:g}; {_before(lost, time)}"
        yield _cause("friction", time, friction, found, likely)


def _friction_under(run: RunView, foot: int, tick: int) -> float:
    """Friction of the ground under a sole [-]."""
    known = beliefs(run)
    boxes = run.constants.unforeseen
    under = [
        friction
        for key, friction in known.slippery.items()
        if any(_stands_on(run, foot, tick, number) for number in boxes.get(key, ()))
    ]
    return min((known.friction[0], *under))


def _stands_on(run: RunView, foot: int, tick: int, number: int) -> bool:
    """Return true if a box of the ground carries a sole."""
    place = np.append(run.sole(foot)[tick, :2], run.sole_yaw[tick, foot])[None]
    half = 0.5 * np.array([run.constants.foot_length, run.constants.foot_width])
    return feet.terrain_of(run).carries(place, half, number)


def _stepped(run: RunView, lost: Loss) -> Iterator[Finding]:
    """A foot on ground that is clearly higher or lower than believed, but where the robot starts."""
    boxes = {key: numbers for key, numbers in run.constants.unforeseen.items() if _height(run, key) >= LEAST_STEP}
    if not boxes or not run.has("/contact", "/reference"):
        return
    felt = run.field("/contact", "felt") != 0
    for foot in (0, 1):
        for start, end in runs_of(felt[:, foot]):
            begin, over = float(run.time[start]), float(run.time[end - 1])
            if start < run.walking.start or not lost.overlaps(begin, over):
                continue
            for key, numbers in boxes.items():
                if any(_stands_on(run, foot, (start + end) // 2, number) for number in numbers):
                    found = f"a foot comes upon ground that is not as believed at {begin:.3f} s ({key})"
                    yield _cause("ground", begin, _height(run, key), found, _before(lost, begin))
                    return


def _height(run: RunView, key: str) -> float:
    """Height over the believed one of the ground that a key has put there, for the reference robot [m]."""
    scenario = scenario_of(run.log)
    errors, length = scenario.errors, run.constants.similarity.length
    if key.startswith("errors.ground."):
        return abs((errors.ground or ())[int(key.rpartition(".")[2])].height) / length
    tilt = {"errors.ground_pitch": errors.ground_pitch, "errors.ground_roll": errors.ground_roll}
    if key in tilt:
        return abs(tilt[key] or 0.0) * run.constants.foot_length / length
    noise = errors.ground_noise if key == "errors.ground_noise" else scenario.terrain.height_noise
    return (noise or 0.0) / length


def _lasting(run: RunView, lost: Loss) -> Iterator[Finding]:
    """Faults that last for all the run and are more than walks bear, the largest first."""
    known = beliefs(run)
    found = [(one.size, one.kind, one.what) for one in known.departures]
    if known.sensors:
        found.append((_misled(run, lost), "sensors", known.sensors[0]))
    for size, kind, what in sorted(found, key=lambda one: -one[0]):
        if size >= 1.0:
            likely = f"walks bear {'no more than that' if size < 1.5 else f'1/{size:.0f} of it'}"
            yield _cause(kind, None, size, what, likely if np.isfinite(size) else "")


def _misled(run: RunView, lost: Loss) -> float:
    """Largest error of the CoM that was given before balance is lost, over the one that deserves a look [-]."""
    before = run.time <= lost.time
    if run.has(SENSED):
        errors = [run.field(SENSED, "com_error")[before]]  # where the robot is in the world no sensor tells
    else:
        planner = run.log["/planner_state"] if run.has("/planner_state") else None
        errors = [(run.field("/estimate", "com") - run.field("/truth", "com"))[before]] if run.has("/estimate") else []
        if planner is not None:
            rows, near = run.rows_at("/truth", planner.time_ns)
            given = near & (rows < run.ticks) & (planner.time <= lost.time)
            error = planner.field("com")[given] - run.field("/truth", "com")[rows[given]]
            errors.append(error * (1.0, 1.0, 0.0))  # the planner has a height of its own
    worst = max((float(np.nanmax(np.linalg.norm(error, axis=1), initial=0.0)) for error in errors), default=0.0)
    return worst / (DRIFT * run.constants.similarity.length)
