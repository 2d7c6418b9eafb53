"""Tables of keys: what the layers below call them, and which of them each fidelity feels."""

from dataclasses import dataclass

from surefoot.errors import ParameterError
from surefoot.planner.references.com_height import Rise
from surefoot.scenarios.errors import Key, Problem
from surefoot.scenarios.file.schema import PendulumSettings, PlannerSettings
from surefoot.scenarios.file.sensing import SENSOR_KEYS

_NAMES: dict[Key, Key] = {
    ("gait", "apex_ss"): ("gait", "apex_single"),
    ("gait", "apex_ds"): ("gait", "apex_double"),
    ("gait", "first_foot"): ("gait", "footsteps"),
    ("gait", "bouts"): ("gait",),
    ("bout", "stand"): ("gait", "initial_stand"),
    ("bout",): ("gait",),
    ("stride", "x"): ("gait", "step_length"),
    ("stride", "y"): ("gait", "lateral_step"),
    ("stride", "yaw"): ("gait", "turn"),
    ("stride", "width"): ("gait", "step_width"),
    ("velocity",): ("gait", "velocity"),
    ("footsteps",): ("gait", "footsteps"),
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
    """The problem that a part's refusal is to the user: its key in the scenario's words, the fault, what is right."""
    if not isinstance(refusal, ParameterError):
        return Problem((), str(refusal).rstrip("."), "change the scenario so that it fits")
    return Problem(scenario_key(refusal.key), refusal.what, refusal.right)


_NO_CONTACT = (
    ("gait", "pelvis_yaw"),
    ("gait", "pelvis_list"),
    ("terrain", "friction"),
    ("terrain", "height_noise"),
    ("sensing", "force_estimate"),
    ("start", "angle_noise"),
    ("errors", "friction"),
    ("errors", "torso_com"),
    ("errors", "ground"),
    ("errors", "ground_noise"),
    ("errors", "ground_pitch"),
    ("errors", "ground_roll"),
    *(("sensing", name) for name in SENSOR_KEYS),
    ("rates", "physics"),
)
"""Keys that the pendulum, whose feet are ideal and which has no joints, does not feel."""


_OF_A_PLANNER = (
    *(("planner", name) for name in PlannerSettings.model_fields if name != "sample_time"),
    *(("sensing", name) for name in ("com_noise", "zmp_noise", "force_estimate")),
    *(("gait", name) for name in ("swing_height", "apex_single", "apex_double", "heel_off", "heel_strike")),
    *(("gait", name) for name in ("pelvis_yaw", "pelvis_list")),
)
"""Keys that mean nothing to what walks without a plan."""


@dataclass(frozen=True, slots=True)
class Fidelity:
    """The fidelity of a run: the thing that walks.

    Attributes:
        thing: it, in the words of a message.
        has_body: whether it has masses, joints and contacts.
        rise: support phase in which its CoM climbs unless the scenario says it. A pendulum can do what the paper does,
            and climbs in double support; legs cannot, and climb in single support.
        unfelt: keys, of a group each, without effect on it.
    """

    thing: str
    has_body: bool
    rise: Rise
    unfelt: tuple[tuple[str, str], ...]


FIDELITIES = {
    "full": Fidelity(
        "whole body", True, Rise.SINGLE, tuple(("pendulum", name) for name in PendulumSettings.model_fields)
    ),
    "pendulum": Fidelity("pendulum", False, Rise.DOUBLE, _NO_CONTACT),
    "seat": Fidelity(
        "controller without a planner",
        True,
        Rise.SINGLE,
        (*(("pendulum", name) for name in PendulumSettings.model_fields), *_OF_A_PLANNER),
    ),
}
"""Fidelities by the kind of walker: the values of the key ``fidelity``, and ``seat`` beside the key ``controller``."""
