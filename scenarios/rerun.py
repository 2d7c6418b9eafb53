"""Runs the scenario of a log again."""

from pathlib import Path

from scenarios.errors import LogError, ScenarioError
from scenarios.file.schema import Scenario
from scenarios.log import read
from scenarios.run import LOG_NAME
from scenarios.verdict import SCENARIO_FILE

LOG_ENDING = ".mcap"
RUNS, AGAIN = Path("runs"), Path("runs/again")
"""Where runs go by default, and where the repetition of one goes that lies there."""


def is_log(reference: str) -> bool:
    """Whether a reference to a scenario is the path of a log."""
    return reference.endswith(LOG_ENDING)


def attached_scenario(path: str) -> tuple[str, str]:
    """Text of the scenario that a log carries, and what to call it in messages.

    Raises:
        ScenarioError: the log cannot be read, or carries none.
    """
    try:
        log = read(path)
        text = log.attachments[SCENARIO_FILE].decode()
    except LogError as error:
        raise ScenarioError([str(error)]) from None
    except (KeyError, UnicodeDecodeError):
        what = f"{path}: carries no readable {SCENARIO_FILE}, so it cannot be run again"
        raise ScenarioError([f"{what}; give a log that `surefoot run` has written"]) from None
    return text, f"{path}/{SCENARIO_FILE}"


def output_folder(reference: str, scenario: Scenario, chosen: Path | None) -> Path:
    """Where a run goes; never over the log that it repeats.

    Args:
        reference: scenario or log.
        scenario: to run.
        chosen: by the user; None for the default.

    Raises:
        ScenarioError: the user chose the folder in which the log would be replaced.
    """
    out = RUNS if chosen is None else chosen
    target = out / f"{scenario.name}-{scenario.seed}" / LOG_NAME
    if not is_log(reference) or not target.exists() or not target.samefile(reference):
        return out
    if chosen is not None:
        raise ScenarioError([f"--out {chosen}: the run would replace {reference}; choose another directory"])
    return AGAIN
