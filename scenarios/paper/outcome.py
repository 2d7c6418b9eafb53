"""What became of an experiment, read from its log alone; and whether a log of it is already there."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

from scenarios.errors import LogError, ScenarioError, SetupError
from scenarios.file.load import load_scenario
from scenarios.file.schema import Scenario
from scenarios.log import Log, read
from scenarios.paper.experiment import Experiment
from scenarios.provenance import versions
from scenarios.run import LOG_NAME, run_scenario, scenario_yaml
from scenarios.verdict import END_RECORD, SCENARIO_FILE, judge

ENDED = ("completed", "fall")
"""How a run ends that is a result; a fall is one."""


@dataclass(frozen=True, slots=True)
class Outcome:
    """What became of an experiment.

    Attributes:
        experiment: that was run.
        log: its log, None when there is none.
        metrics: of the log; empty when the experiment failed.
        failure: why it gave no result, in a sentence; empty when it gave one.
        versions: that made the log.
        written: when it was, as UTC date and time in ISO form.
    """

    experiment: Experiment
    log: Path | None = None
    metrics: Mapping[str, Any] = field(default_factory=dict)
    failure: str = ""
    versions: Mapping[str, str] = field(default_factory=dict)
    written: str = ""


def execute(experiment: Experiment, folder: Path) -> Outcome:
    """Run an experiment, unless its log is there already, and read off its log what became of it.

    Args:
        experiment: to run.
        folder: of all runs.
    """
    try:
        scenario = load_scenario(experiment.base, experiment.overrides)
        log = folder / experiment.folder / LOG_NAME
        if not is_done(log, scenario):
            run_scenario(scenario, folder)
        return outcome_of(experiment, log)
    except (ScenarioError, SetupError, LogError) as refusal:
        return Outcome(experiment, failure=" ".join(str(refusal).split()))
    except Exception as error:
        return Outcome(experiment, failure=f"internal error, {type(error).__name__}: {error}")


def is_done(path: Path, scenario: Scenario) -> bool:
    """Whether a log is whole, and of this scenario, this code and these versions."""
    try:
        log = read(path)
        same_scenario = log.attachments.get(SCENARIO_FILE) == scenario_yaml(scenario).encode()
    except LogError:
        return False
    ended = log.metadata.get(END_RECORD, {}).get("kind") in ENDED
    return ended and not log.truncated and same_scenario and _made_by(log) == _relevant(versions())


def outcome_of(experiment: Experiment, path: Path) -> Outcome:
    """Read off a log what became of an experiment.

    Raises:
        LogError: the log cannot be read.
    """
    log = read(path)
    end = log.metadata.get(END_RECORD, {})
    written = datetime.fromtimestamp(path.stat().st_mtime, UTC).isoformat(timespec="seconds")
    made = dict(log.metadata.get("versions", {}))
    if end.get("kind") not in ENDED:
        failure = f"the run ended at {end.get('time', '?')} s: {end.get('reason') or 'its log was cut off'}"
        return Outcome(experiment, path, {}, failure, made, written)
    return Outcome(experiment, path, judge(log).metrics, "", made, written)


def _made_by(log: Log) -> dict[str, str]:
    return _relevant(log.metadata.get("versions", {}))


def _relevant(made: Mapping[str, str]) -> dict[str, str]:
    """Versions that a run depends on: not the revision, whose digest says more and does not change with a text."""
    return {name: version for name, version in made.items() if name != "git_revision"}
