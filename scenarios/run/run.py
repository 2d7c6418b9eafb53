"""Runs a scenario: the log is written while the loop goes on, and the verdict is then computed from the log file."""

import gc
import sys
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import TYPE_CHECKING, cast

from threadpoolctl import ThreadpoolController, threadpool_limits

from surefoot.errors import PartError
from surefoot.models.facts import knees_straight, knees_turn, named_roles
from surefoot.models.mjcf import without_looks
from surefoot.native import modules
from surefoot.parts.guard import said, shown
from surefoot.planner.laws.profiles import Profile
from surefoot.scenarios.errors import LogError, ScenarioError, SetupError
from surefoot.scenarios.file.registries import DEFAULTS
from surefoot.scenarios.file.schema import Scenario
from surefoot.scenarios.judge.metrics import judged_topics
from surefoot.scenarios.judge.verdict import Verdict, judge
from surefoot.scenarios.log import AttachedFile, LogWriter, Thinning, read
from surefoot.scenarios.output import reason
from surefoot.scenarios.record.provenance import (
    AGENDA_RECORD,
    END_RECORD,
    LOG_NAME,
    PARTS_RECORD,
    RECORD,
    SCENARIO_FILE,
    VERDICT_NAME,
    RunConstants,
    run_folders,
    versions,
)
from surefoot.scenarios.run.interrupts import Interrupts, held_back
from surefoot.scenarios.run.skeleton import ClosedLoop, End, OnProgress, Progress, fault_end, refusing, run_loop
from surefoot.scenarios.setup.checks.notes import agenda
from surefoot.scenarios.setup.load import load as load_scenario
from surefoot.scenarios.setup.walk import Walk, resolve

if TYPE_CHECKING:
    from surefoot.models.types import RobotDescription
    from surefoot.scenarios.run.assembly import Parts


@dataclass(frozen=True, slots=True)
class Result:
    """The result of a run.

    Attributes:
        verdict: computed from the log.
        log: path of the log.
        interrupted: whether a signal, Ctrl-C or another, came while it went on or was judged.
    """

    verdict: Verdict
    log: Path
    interrupted: bool

    def __repr__(self) -> str:
        """The verdict in a word, with its reasons, and where the log is."""
        why = f" ({'; '.join(self.verdict.reasons)})" if self.verdict.reasons else ""
        return f"<Result {'pass' if self.verdict.passed else 'fail'}{why}, log {self.log}>"


Simulate = Callable[[Walk, LogWriter, OnProgress], End]
"""The closed loop from begin to end: opens its channels in the writer, appends to them and says how it ended."""


def run(
    scenario: Scenario | str | Path,
    seed: int | None = None,
    out: str | Path = "runs",
    *,
    planner: Profile | None = None,
    parts: "Parts | None" = None,
    robot: "RobotDescription | None" = None,
) -> Result:
    """Run a scenario, log it and judge the log.

        result = surefoot.run("walk", seed=3)
        result.verdict["cop_ratio_p99"], surefoot.read(result.log)["/truth"].field("com")

    Args:
        scenario: a scenario, or what `surefoot.load` takes to find one.
        seed: over that of the scenario.
        out: directory that gets a folder of the run's own, ``<scenario>-<seed>`` or, where that is taken,
            ``<scenario>-<seed>-2`` and so on, with ``log.mcap`` and ``verdict.json``.
        planner: a profile in place of the one that the scenario names.
        parts: of the loop in full physics, in place of surefoot's own.
        robot: a description in place of the robot that the scenario names.

    Raises:
        ScenarioError: the scenario cannot be found, read or run.
        SetupError: a part refuses it; no log is left.
        LogError: the log or the verdict cannot be written.
    """
    loaded = scenario if isinstance(scenario, Scenario) else load_scenario(scenario)
    if seed is not None:
        loaded = loaded.model_copy(update={"seed": seed})
    given: dict[str, object] = {"planner": planner, "robot": robot, **({} if parts is None else parts.given())}

    def simulate(walk: Walk, writer: LogWriter, on_progress: OnProgress) -> End:
        loop = closed_loop(walk, writer, parts)
        note_parts(writer, given)
        return run_loop(loop, on_progress)

    return run_scenario(loaded, Path(out), None, simulate, robot, planner)


def run_scenario(
    scenario: Scenario,
    out: Path,
    on_progress: OnProgress | None = None,
    simulate: Simulate | None = None,
    robot: "RobotDescription | None" = None,
    profile: Profile | None = None,
    on_begin: Callable[[Path], None] | None = None,
) -> Result:
    """Run a scenario and judge it.

    Args:
        scenario: what to run.
        out: directory that gets the run's own folder.
        on_progress: called with the progress of the run.
        simulate: the closed loop; that of the scenario's fidelity by default.
        robot: its robot; described from the scenario by default.
        profile: the planner's profile; the one that the scenario names by default.
        on_begin: called with the path of the log, once it is there.

    Raises:
        LogError: the log or the verdict cannot be written.
        SetupError: the loop cannot be set up as the scenario asks; no log is left.
    """
    with refusing():
        walk = resolve(scenario, robot, profile)
    with held_back() as interrupts:
        with _own_folder(out, walk) as folder, one_thread(), open_log(folder / LOG_NAME, walk) as writer:
            if on_begin is not None:
                on_begin(writer.path)
            end = _watched(simulate or _simulate, walk, writer, on_progress, interrupts)
        verdict = judge(read(writer.path))
        verdict.write(folder / VERDICT_NAME)
    return Result(verdict, writer.path, end.kind == "interrupted" or interrupts.count > 0)


def own_folder(out: Path, scenario: str, seed: int) -> Path:
    """Make a folder that no other run of a scenario's name and seed has or will have.

    Raises:
        LogError: it cannot be made.
    """
    made_folder(out)
    for folder in run_folders(out, scenario, seed):
        try:
            folder.mkdir()
        except FileExistsError:
            continue
        except OSError as error:
            raise unmade(folder, error) from None
        return folder
    raise AssertionError("there is always another name")


@contextmanager
def _own_folder(out: Path, walk: Walk) -> Iterator[Path]:
    """A run's own folder, which is taken away if the run leaves nothing in it; LogError if it cannot be made."""
    folder = own_folder(out, walk.name, walk.seed)
    try:
        yield folder
    finally:
        with suppress(OSError):
            folder.rmdir()


def one_thread() -> threadpool_limits:
    """One thread for linear algebra: matrices of this size lose more in waiting than they gain in sharing."""
    if modules.missing():  # here, since what is loaded later has as many threads as it likes
        import scipy.linalg  # noqa: F401
    return cast("threadpool_limits", _libraries(len(sys.modules)).limit(limits=1))


@lru_cache(maxsize=1)
def _libraries(_modules: int) -> ThreadpoolController:
    """The libraries that are loaded, looked for again when modules were imported, with which they come."""
    return ThreadpoolController()


_YOUNG = 1
"""Generation up to which Python's objects are young: old are those of modules, which take far longer."""


def closed_loop(walk: Walk, writer: LogWriter, parts: "Parts | None" = None) -> ClosedLoop:
    """The closed loop of a walk's fidelity at its start; what it needs is imported only then.

    Args:
        walk: what to run.
        writer: gets every boundary crossing.
        parts: of the loop in full physics that a user replaces.

    Raises:
        SetupError: a part refuses the walk.
    """
    with refusing():
        loop = _LOOPS[walk.keys.walker](walk, writer, parts)
    # What was made for it is looked through for garbage here: in a tick that would take a millisecond.
    gc.collect(_YOUNG)
    return loop


def _full(walk: Walk, writer: LogWriter, parts: "Parts | None") -> ClosedLoop:
    from surefoot.scenarios.run.full import full_loop

    return full_loop(walk, writer, parts)


def _pendulum(walk: Walk, writer: LogWriter, _: "Parts | None") -> ClosedLoop:
    from surefoot.scenarios.run.pendulum import pendulum_loop

    return pendulum_loop(walk, writer)


def _seat(walk: Walk, writer: LogWriter, parts: "Parts | None") -> ClosedLoop:
    from surefoot.scenarios.run.seat import seat_loop

    return seat_loop(walk, writer, parts)


_LOOPS = {"full": _full, "pendulum": _pendulum, "seat": _seat}
"""Makers of the loop of a kind of walker."""


def note_parts(writer: LogWriter, given: Mapping[str, object]) -> None:
    """Write down which parts a program has put in the place of surefoot's own, for no log can carry them."""
    others = {name: shown(part) for name, part in given.items() if part is not None}
    if others:
        writer.add_metadata(PARTS_RECORD, others)


def _simulate(walk: Walk, writer: LogWriter, on_progress: OnProgress) -> End:
    return run_loop(closed_loop(walk, writer), on_progress)


def open_log(path: Path, walk: Walk) -> LogWriter:
    """A log that says what its run is, before anything has happened.

    Raises:
        LogError: it cannot be written.
    """
    metadata = {
        RECORD: run_constants(walk).to_metadata(),
        AGENDA_RECORD: agenda(walk).to_metadata(),
        "versions": versions(),
    }
    attachments = [
        AttachedFile(SCENARIO_FILE, "application/yaml", walk.text.encode()),
        AttachedFile("robot.xml", "application/xml", without_looks(walk.robot.mjcf).encode()),
    ]
    rate = walk.log.rate
    thinning = None if rate is None else Thinning(rate, judged_topics())
    return LogWriter(path, metadata, attachments, keep=walk.log.keep, thinning=thinning)


def run_constants(walk: Walk) -> RunConstants:
    """Collect what the metrics need of a walk and its robot."""
    robot = walk.robot
    return RunConstants(
        scenario=walk.name,
        fidelity=walk.fidelity,
        seed=walk.seed,
        steps_planned=walk.gait.steps,
        mass=walk.true_mass,
        com_height=walk.true_com_height,
        foot_length=float(robot.sole_length),
        foot_width=float(robot.sole_width),
        control_rate=walk.rates.control,
        sample_time=walk.parameters.sample_time,
        joint_names=tuple(robot.joint_names),
        torque_limit=tuple(float(value) for value in robot.torque_limit),
        position_lower=tuple(float(value) for value in robot.position_lower),
        position_upper=tuple(float(value) for value in robot.position_upper),
        velocity_limit=tuple(float(value) for value in robot.velocity_limit),
        terrain=walk.ground.keys.kind,
        plant=walk.pendulum.plant,
        roles=named_roles(robot),
        boxes=tuple(
            (*box.center.tolist(), *box.half_size.tolist(), *box.rotation.ravel().tolist())
            for box in walk.ground.true_terrain.boxes
        ),
        plane=walk.ground.true_terrain.plane,
        size=(walk.size.length, walk.size.mass),
        knee_straight=knees_straight(robot),
        knee_turn=knees_turn(robot),
        unforeseen=walk.unforeseen,
        waypoints=tuple(place[:3] for place in walk.waypoints),
        controller="" if walk.seat is None else walk.seat.name or DEFAULTS["controller"],
    )


def _watched(
    simulate: Simulate, walk: Walk, writer: LogWriter, on_progress: OnProgress | None, interrupts: Interrupts
) -> End:
    """Run the loop and write into the log how it ended, however it ended."""
    last = Progress(0.0, 0.0, "", 0.0)

    def note(progress: Progress) -> None:
        nonlocal last
        last = progress
        interrupts.look()
        if on_progress is not None:
            on_progress(progress)

    try:
        with interrupts.looked_for():
            end = simulate(walk, writer, note)
            interrupts.look()
    except (KeyboardInterrupt, Exception) as error:
        # A signal that is raised while a compiled part converts an argument is reported as a wrong argument.
        if interrupts.count == 0 and not isinstance(error, KeyboardInterrupt):
            if not isinstance(error, PartError):
                if isinstance(error, ScenarioError | SetupError):
                    writer.discard()
                elif not isinstance(error, LogError):
                    write_end(writer, End("fault", last.time, f"internal error, {said(error)}"))
                raise
            end = fault_end(error, last.time)
        else:
            end = End("interrupted", last.time, "interrupted by the user")
    write_end(writer, end)
    return end


def write_end(writer: LogWriter, end: End) -> None:
    """Write how a run ended, the last record of its log."""
    record = {"kind": end.kind, "time": f"{end.time:.6f}", "reason": end.reason}
    writer.add_metadata(END_RECORD, {**record, "traceback": end.trace} if end.trace else record)


def made_folder(path: Path) -> Path:
    """The directory, made where it was missing.

    Raises:
        LogError: it cannot be made.
    """
    try:
        path.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise unmade(path, error) from None
    return path


def unmade(path: Path, error: OSError) -> LogError:
    """Make the error of a directory that is not there."""
    why = "not a directory" if isinstance(error, FileExistsError) else reason(error)
    return LogError(f"{path}: cannot be created, {why}; choose another directory with --out")
