"""The one table from the words of the layers below to the keys of a scenario file."""

from collections.abc import Mapping

from surefoot.errors import ParameterError
from surefoot.scenarios.errors import Key, Problem

_SPELLED: Mapping[Key, Key] = {
    ("gait", "apex_ss"): ("gait", "apex_single"),
    ("gait", "apex_ds"): ("gait", "apex_double"),
}
"""Parameters of the layers below that are spelled otherwise in a scenario; the others are spelled alike."""


def scenario_problem(refusal: ValueError) -> Problem:
    """What the user is told of the refusal of a part: its key in the scenario's words, the fault, what is right."""
    if not isinstance(refusal, ParameterError):
        return Problem((), str(refusal).rstrip("."), "change the scenario so that it fits")
    return Problem(_SPELLED.get(refusal.key, refusal.key), refusal.what, refusal.right)
