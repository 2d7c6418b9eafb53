"""The scenario that a log carries."""

from dataclasses import replace
from io import BytesIO

from pydantic import ValidationError

from surefoot.scenarios.errors import LogError, Problem, ScenarioError
from surefoot.scenarios.file.dumped import dumped_values
from surefoot.scenarios.file.names import unknown
from surefoot.scenarios.file.schema import Scenario
from surefoot.scenarios.file.source import decoded
from surefoot.scenarios.file.translate import without
from surefoot.scenarios.judge.digest import Source
from surefoot.scenarios.record.provenance import SCENARIO_FILE


def scenario_of(log: Source) -> Scenario:
    """The scenario that a log carries, without the names that only packages know which are not installed here.

    Raises:
        LogError: it carries none that can be read.
    """
    return known_part(log)[0]


def known_part(log: Source) -> tuple[Scenario, list[Problem]]:
    """The scenario of a log, and which of its names nobody knows here.

    Raises:
        LogError: it carries none that can be read.
    """
    if SCENARIO_FILE not in log.attachments:
        what = f"{log.path}: has no attachment {SCENARIO_FILE}, without which its criteria are unknown"
        raise LogError(f"{what}; give the log as `surefoot run` has written it")
    try:
        text = decoded(BytesIO(log.attachments[SCENARIO_FILE]), SCENARIO_FILE)
        keys = dumped_values(text, SCENARIO_FILE)
        absent = unknown(keys)
        # Without its kind the other keys of the ground mean nothing.
        places = [replace(one, key=one.key[:1]) if one.key[0] == "terrain" else one for one in absent]
        return Scenario.model_validate(without(keys, places)), absent
    except ScenarioError as error:
        why = f", {error.problems[0]}" if error.problems else ""
        raise LogError(f"{log.path}: holds no readable scenario; its criteria are unknown{why}") from None
    except (KeyError, TypeError, ValidationError, ValueError, RecursionError):
        raise LogError(f"{log.path}: holds no readable scenario; its criteria are unknown") from None
