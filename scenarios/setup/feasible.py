"""Checks that a robot can do a walk, by its stances and first steps; else a walk of the kind that it can do.

What a refusal proposes has been tried: the scenario with it goes through every check that comes before a run.
"""

import math
from dataclasses import dataclass, replace
from functools import lru_cache
from shlex import quote
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np
import yaml
from numpy.typing import NDArray

from surefoot.errors import ParameterError
from surefoot.models.types import same_robot
from surefoot.parts.plugins import OWN_PACKAGE
from surefoot.planner.laws.names import PROFILES
from surefoot.scenarios.errors import Key, ScenarioError
from surefoot.scenarios.file.criteria import Bound
from surefoot.scenarios.file.schema import Scenario
from surefoot.scenarios.setup.keys import scenario_key
from surefoot.scenarios.setup.robot.body import Body, feet_at, leg_inertia
from surefoot.scenarios.setup.stances.rehearsal import check_legs, check_turns
from surefoot.scenarios.setup.stances.stances import check_stances
from surefoot.scenarios.setup.stances.start import start_posture
from surefoot.scenarios.setup.terrain import KINDS
from surefoot.scenarios.setup.walk import Walk, resolve

if TYPE_CHECKING:
    from surefoot.planner.parameters import LegInertia

Proposal = dict[str, Any]
"""Values by dotted key."""

_STRIDE = ("step_length", "lateral_step", "turn")
_STEPS = ("gait", "step_length")
_TRIES = 8
_LESS = 0.8
"""Share of steps, ground or tempo that is tried after a refusal [-]."""

_HEIGHTS = (1.0, 0.96, 1.03)
"""CoM heights that are tried in turn, over the robot's usual one [-]."""

_DIGITS = 3


def made_ready(walk: Walk, body: Body) -> "tuple[NDArray[np.float64], LegInertia]":
    """Configuration at the start, shape (nq,), and legs, of a walk that its robot can do.

    Raises:
        ParameterError: it cannot; says what would be right, which has been tried.
    """
    try:
        return _fit(walk, body)
    except ParameterError as refusal:
        if refusal.key[:1] == ("commands",):
            raise
        found = proposed(walk, body, refusal.key)
        right = f"nothing calmer suits '{walk.robot.name}' either"
        if found:
            unmet = unmet_by(found, walk)
            out = f" (which leaves out {', '.join(unmet)} of the criteria)" if unmet else ""
            right = f"take for example {proposal_text(found)}{out}"
        raise ParameterError(refusal.key, refusal.what, right) from None


def proposal_text(proposal: Proposal) -> str:
    """A proposal as options of a command line, to be copied as they stand."""
    return " ".join(f"--set {quote(f'{key}={_value(value)}')}" for key, value in proposal.items())


_FOLLOWS: dict[str, tuple[str, ...]] = {
    "speed_mean": (*_STRIDE, "single_support", "velocity"),
    "displacement": (*_STRIDE, "velocity"),
    "path_length": (*_STRIDE, "velocity"),
    "heading_change": ("turn", "velocity"),
}
"""Metrics that say how fast or how far a walk goes, each with the keys that make it go less."""


def unmet_by(proposal: Proposal, walk: Walk) -> tuple[str, ...]:
    """Criteria that ask a walk to go as fast or as far as it does without the proposal."""
    changed = {key.rpartition(".")[2] for key in proposal}
    asked = ((name, walk.keys.criteria.get(name)) for name, keys in _FOLLOWS.items() if changed & set(keys))
    return tuple(name for name, bound in asked if bound is not None and _asks(bound))


def _asks(bound: Bound) -> bool:
    """Return true if a bound asks for some way, to whichever side; one around zero asks for none."""
    least, most = (np.atleast_1d(0.0 if limit is None else limit) for limit in (bound.min, bound.max))
    return bool((least > 0.0).any() or (most < 0.0).any())


def _value(value: Any) -> str:
    if isinstance(value, float):
        return f"{value:g}"
    return yaml.safe_dump(value, default_flow_style=True, width=math.inf).strip()


def proposed(walk: Walk, body: Body, key: Key) -> Proposal | None:
    """The setting over a walk, refused at a key, of which its robot can do the result; None if none was found.

    Whatever the next refusal is about gives way next.
    """
    from surefoot.scenarios.setup.load import read_scenario

    keys, calm = read_scenario(walk.text, walk.name, walk.name), _Calm()
    for _ in range(_TRIES):
        calm = calm.after(scenario_key(key), climbs=bool(_ground(keys)))
        proposal = calm.proposal(keys, walk)
        try:
            _fit(
                resolve(read_scenario(walk.text, walk.name, walk.name, proposal), walk.robot, walk.formulation.profile),
                body,
            )
        except ParameterError as refusal:
            key = refusal.key
        except ScenarioError:
            key = _STEPS
        else:
            return proposal
    return None


class _Likeness:
    """A walk of a body, equal to those that differ in nothing on which stances and first steps depend.

    Of what other packages bring nobody knows what it depends on.
    """

    _ASIDE: ClassVar = {"name", "seed", "pushes", "faults", "criteria", "requirements"}

    def __init__(self, walk: Walk, body: Body) -> None:
        self.walk, self.body = walk, body
        self._keys = walk.keys.model_dump_json(exclude=self._ASIDE)
        self._rest = walk.size, walk.wider, walk.foot_length
        self._own = KINDS.package(walk.keys.terrain.kind) == OWN_PACKAGE and PROFILES.owns(walk.formulation.profile)

    def __hash__(self) -> int:
        return hash(self._keys)

    def __eq__(self, other: object) -> bool:
        return (
            isinstance(other, _Likeness)
            and (self._own or self is other)
            and (self._keys, self._rest) == (other._keys, other._rest)
            and self.walk.formulation.profile is other.walk.formulation.profile
            and same_robot(self.body.robot, other.body.robot)
        )


def _fit(walk: Walk, body: Body) -> "tuple[NDArray[np.float64], LegInertia]":
    """See `made_ready`; its ParameterError says what is wrong and not what would be right."""
    posture, leg = _fitting(_Likeness(walk, body))
    return posture.copy(), leg


@lru_cache(maxsize=32)
def _fitting(alike: _Likeness) -> "tuple[NDArray[np.float64], LegInertia]":
    walk, body = alike.walk, alike.body
    posture = start_posture(walk, body)
    check_stances(walk, body, posture)
    leg = leg_inertia(body.model, body.frames, posture, body.leg_joints)
    check_turns(walk)
    check_legs(walk, feet_at(body, posture), leg)
    return posture, leg


@dataclass(frozen=True, slots=True)
class _Calm:
    """Shares of steps, ground and time to give way by, a posture to take, how often something else was in the way."""

    steps: float = 1.0
    ground: float = 1.0
    time: float = 1.0
    posture: int = 0
    refused: int = 0

    def after(self, key: Key, climbs: bool) -> "_Calm":
        """The settings to try after a refusal at a key, on ground that is uneven or not."""
        if key == ("gait", "com_height"):
            return replace(self, posture=self.posture + 1)
        if key == ("gait", "single_support"):
            return replace(self, steps=_LESS * self.steps, time=self.time / _LESS)
        if key[-1:] in (("turn",), ("velocity",)):
            return replace(self, steps=_LESS * self.steps)
        if self.refused % 2:
            return replace(self, posture=self.posture + 1, refused=self.refused + 1)
        smaller = replace(self, refused=self.refused + 1)
        return replace(smaller, ground=_LESS * self.ground) if climbs else replace(smaller, steps=_LESS * self.steps)

    def proposal(self, keys: Scenario, walk: Walk) -> Proposal:
        """In the keys of a scenario; where steps follow from the ground they stay."""
        ground, robot = _ground(keys), walk.robot
        found: Proposal = {} if ground or self.steps == 1.0 else _shorter(keys, self.steps)
        if self.ground < 1.0:
            found |= _times(keys.terrain, "terrain", ground, self.ground)
        if self.time > 1.0 and keys.gait.speed is None:
            found |= _times(keys.gait, "gait", ("single_support",), self.time)
        if self.posture:
            height = robot.com_height * _HEIGHTS[(self.posture - 1) % len(_HEIGHTS)]
            found["gait.com_height"] = _rounded(height)
            found["gait.step_width"] = _rounded(max(robot.hip_width, robot.shank_spacing))
        return found


def _ground(keys: Scenario) -> tuple[str, ...]:
    """Keys that make the ground of a scenario uneven."""
    return KINDS[keys.terrain.kind].uneven


def _shorter(keys: Scenario, share: float) -> Proposal:
    """The walk with steps of a share of their size, or with a share of its speed or its velocities."""
    if keys.gait.speed is not None:
        return _times(keys.gait, "gait", ("speed",), share)
    if not keys.gait.velocity:
        return _times(keys.gait, "gait", _STRIDE, share)
    slower = ({name: _rounded(share * value) for name, value in velocity} for velocity in keys.gait.velocity)
    return {
        "gait.velocity": [
            {**one, "time": float(f"{velocity.time:.6g}")}
            for one, velocity in zip(slower, keys.gait.velocity, strict=True)
        ]
    }


def _times(group: Any, name: str, keys: tuple[str, ...], share: float) -> Proposal:
    """Values of the keys that are not zero, times a share."""
    given = {f"{name}.{key}": _rounded(share * getattr(group, key)) for key in keys}
    return {key: value for key, value in given.items() if value}


def _rounded(value: float) -> float:
    return float(f"{value:.{_DIGITS}g}")
