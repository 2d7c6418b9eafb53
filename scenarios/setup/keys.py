"""The one table from the words of the layers below to the keys of a scenario file."""

from surefoot.errors import ParameterError
from surefoot.scenarios.errors import Key, Problem

_NAMES: dict[Key, Key] = {
    ("gait", "apex_ss"): ("gait", "apex_single"),
    ("gait", "apex_ds"): ("gait", "apex_double"),
    ("gait", "first_foot"): ("gait", "footsteps"),
    ("gait", "bouts"): ("gait",),
    ("bout", "stand"): ("gait", "initial_stand"),
    ("bout",): ("gait",),
    ("stride", "length"): ("gait", "step_length"),
    ("stride", "lateral"): ("gait", "lateral_step"),
    ("stride", "turn"): ("gait", "turn"),
    ("stride", "width"): ("gait", "step_width"),
    ("velocity",): ("gait", "velocity"),
    ("footsteps",): ("gait", "footsteps"),
    ("terrain", "depth"): ("terrain", "tread"),
    ("parameters", "moves"): ("planner", "control_horizon"),
    ("parameters",): ("planner",),
    ("foot_length",): ("robot_options", "foot_length"),
    ("foot_width",): ("robot_options", "foot_width"),
}
"""Parameters of the planner whose names differ from the keys; a longer entry goes before a shorter one."""


def scenario_key(key: Key) -> Key:
    """The scenario's key for a parameter, which may lie deeper than the scenario goes."""
    for length in range(len(key), 0, -1):
        if key[:length] in _NAMES:
            return (*_NAMES[key[:length]], *key[length:])
    return key


def scenario_problem(refusal: ValueError) -> Problem:
    """What the user is told of the refusal of a part: its key in the scenario's words, the fault, what is right."""
    if not isinstance(refusal, ParameterError):
        return Problem((), str(refusal).rstrip("."), "change the scenario so that it fits")
    return Problem(scenario_key(refusal.key), refusal.what, refusal.right)
