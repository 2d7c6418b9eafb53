"""Runs a scenario: the log is written while the loop goes on, and the verdict is then computed from the log file."""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import yaml
from threadpoolctl import threadpool_limits

from surefoot.scenarios.errors import LogError, ScenarioError, SetupError
from surefoot.scenarios.file.schema import Scenario
from surefoot.scenarios.judge.verdict import END_RECORD, SCENARIO_FILE, Verdict, judge
from surefoot.scenarios.log import AttachedFile, LogWriter, read
from surefoot.scenarios.loop.skeleton import End, OnProgress, Progress
from surefoot.scenarios.record.provenance import RECORD, RunConstants, versions
from surefoot.scenarios.setup.gait import step_count
from surefoot.scenarios.setup.ground import true_terrain_of
from surefoot.scenarios.setup.robot import describe

if TYPE_CHECKING:
    from surefoot.models.types import RobotDescription


LOG_NAME = "log.mcap"
VERDICT_NAME = "verdict.json"


@dataclass(frozen=True, slots=True)
class Result:
    """What a run left behind.

    Attributes:
        verdict: computed from the log.
        log: path of the log.
        interrupted: whether the user stopped the run.
    """

    verdict: Verdict
    log: Path
    interrupted: bool


Simulate = Callable[[Scenario, "RobotDescription", LogWriter, OnProgress], End]
"""The closed loop: opens its channels in the writer, appends to them and says how it ended."""


def run_scenario(
    scenario: Scenario,
    out: Path,
    on_progress: OnProgress | None = None,
    simulate: Simulate | None = None,
    robot: "RobotDescription | None" = None,
) -> Result:
    """Run a scenario and judge it.

    Args:
        scenario: what to run.
        out: directory that gets ``<scenario>-<seed>/log.mcap`` and ``verdict.json``.
        on_progress: is told where the run is.
        simulate: the closed loop; that of the scenario's fidelity by default.
        robot: its robot; described from the scenario by default.

    Raises:
        LogError: the log or the verdict cannot be written.
        SetupError: the loop cannot be set up as the scenario asks; no log is left.
    """
    simulate = simulate or closed_loop(scenario.fidelity)
    robot = robot or describe(scenario)
    folder = made_folder(out / f"{scenario.name}-{scenario.seed}")
    one_thread = threadpool_limits(1)  # matrices of this size lose more in waiting than they gain in sharing
    with one_thread, LogWriter(folder / LOG_NAME, _metadata(scenario, robot), _attachments(scenario, robot)) as writer:
        (folder / VERDICT_NAME).unlink(missing_ok=True)
        end = _watched(simulate, scenario, robot, writer, on_progress)
    verdict = judge(read(folder / LOG_NAME))
    verdict.write(folder / VERDICT_NAME)
    return Result(verdict, folder / LOG_NAME, end.kind == "interrupted")


def closed_loop(fidelity: str) -> Simulate:
    """The closed loop of a fidelity, imported only when it is needed."""
    if fidelity == "pendulum":
        from surefoot.scenarios.loop import pendulum as pendulum_loop

        return pendulum_loop.simulate
    from surefoot.scenarios.loop import full as loop

    return loop.simulate


def scenario_yaml(scenario: Scenario) -> str:
    """The scenario as run: every key with its value."""
    return yaml.safe_dump(scenario.model_dump(mode="json", exclude_none=True), sort_keys=False)


def run_constants(scenario: Scenario, robot: "RobotDescription") -> RunConstants:
    """Collect what the metrics need of a scenario and its robot."""
    return RunConstants(
        scenario=scenario.name,
        fidelity=scenario.fidelity,
        seed=scenario.seed,
        steps_planned=step_count(scenario.gait),
        mass=float(robot.mass) / scenario.errors.mass_scale,
        com_height=scenario.gait.com_height - scenario.errors.com_height,
        foot_length=float(robot.sole_length),
        foot_width=float(robot.sole_width),
        control_rate=scenario.rates.control,
        sample_time=scenario.planner.sample_time,
        joint_names=tuple(robot.joint_names),
        torque_limit=tuple(float(value) for value in robot.torque_limit),
        position_lower=tuple(float(value) for value in robot.position_lower),
        position_upper=tuple(float(value) for value in robot.position_upper),
        terrain=scenario.terrain.kind,
        plant=scenario.pendulum.plant,
        boxes=tuple(
            (*box.center.tolist(), *box.half_size.tolist(), *box.rotation.ravel().tolist())
            for box in true_terrain_of(scenario).boxes
        ),
    )


def _watched(
    simulate: Simulate, scenario: Scenario, robot: "RobotDescription", writer: LogWriter, on_progress: OnProgress | None
) -> End:
    """Run the loop and write into the log how it ended, however it ended."""
    last = Progress(0.0, 0.0, "", 0.0)

    def note(progress: Progress) -> None:
        nonlocal last
        last = progress
        if on_progress is not None:
            on_progress(progress)

    try:
        end = simulate(scenario, robot, writer, note)
    except KeyboardInterrupt:
        end = End("interrupted", last.time, "interrupted by the user")
    except LogError:
        raise
    except (ScenarioError, SetupError):
        writer.discard()
        raise
    except Exception as error:
        _write_end(writer, End("fault", last.time, f"internal error, {type(error).__name__}: {error}"))
        raise
    _write_end(writer, end)
    return end


def _write_end(writer: LogWriter, end: End) -> None:
    writer.add_metadata(END_RECORD, {"kind": end.kind, "time": f"{end.time:.6f}", "reason": end.reason})


def _metadata(scenario: Scenario, robot: "RobotDescription") -> dict[str, dict[str, str]]:
    return {RECORD: run_constants(scenario, robot).to_metadata(), "versions": versions()}


def _attachments(scenario: Scenario, robot: "RobotDescription") -> list[AttachedFile]:
    return [
        AttachedFile(SCENARIO_FILE, "application/yaml", scenario_yaml(scenario).encode()),
        AttachedFile("robot.xml", "application/xml", robot.mjcf.encode()),
    ]


def made_folder(path: Path) -> Path:
    """The directory, made where it was missing.

    Raises:
        LogError: it cannot be made.
    """
    try:
        path.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        reason = (error.strerror or str(error)).lower()
        raise LogError(f"{path}: cannot be created, {reason}; choose another directory with --out") from None
    return path
