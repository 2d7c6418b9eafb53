"""The factor of every unit is that of Froude similarity, and the reference robot is left alone to the bit."""

import math
from dataclasses import fields, is_dataclass

import numpy as np
import pytest

from surefoot.errors import ParameterError
from surefoot.planner.laws.profiles import PROFILES
from surefoot.planner.model.filter import FilterNoise
from surefoot.planner.parameters import GroundSearch, PlannerParameters
from surefoot.scenarios.judge.metrics import OWN
from surefoot.similarity import LEG_LENGTH, MASS, REFERENCE_SIZE, Similarity, exponents
from surefoot.wbc.body.limits import JointLimits
from surefoot.wbc.parameters import WbcParameters

pytestmark = pytest.mark.unit

SIZE = Similarity(0.25, 0.02)
H, M = 0.25, 0.02
T = math.sqrt(H)
MEASURED = {
    "wbc.gains.swing": (1 / H, 1 / T),
    "wbc.gains.angular_momentum": 1 / T,
    "wbc.balance.height_stiffness": 1 / H,
    "wbc.balance.dcm": 1.0,
    "wbc.weights.orientation": H**2,
    "wbc.weights.upper_posture": H**2,
    "wbc.weights.acceleration": 1.0,
    "wbc.weights.swing": 1.0,
    "wbc.weights.angular_momentum": 1 / H**2,
    "wbc.weights.force": 1 / M**2,
    "wbc.weights.moment": 1 / (M * H) ** 2,
    "wbc.schedule.felt_force": M,
    "wbc.schedule.early_cap": M,
    "wbc.schedule.loading_time": T,
    "wbc.separation.clearance": H,
    "wbc.arm_swing": 1 / H,
    "planner.jerk_limit": 1 / T,
    "planner.jerk_weight": H**3,
    "planner.zmp_slack": (1.0, H),
    "planner.reach_width": (H, H),
    "planner.swing_speed": T,
    "planner.late_touchdown": T,
    "planner.terminal_weight": 1.0,
    "planner.search.speed": T,
    "planner.search.acceleration": 1.0,
}
"""The rules by which robots of other sizes were first made to walk."""


def value(group, name):
    for part in name.split(".")[1:]:
        group = getattr(group, part)
    return np.array(group)


@pytest.mark.parametrize("name", MEASURED)
def test_a_parameter_follows_the_rule_that_was_measured(name):
    parameters = WbcParameters() if name.startswith("wbc") else PlannerParameters()
    scaled = value(SIZE.scaled(parameters), name)
    np.testing.assert_allclose(scaled, np.array(MEASURED[name]) * value(parameters, name), rtol=1e-12)


@pytest.mark.parametrize(
    ("unit", "powers"),
    [("m", (1, 0, 0)), ("s^4/m^4", (-4, 4, 0)), ("1/(N·m)^2", (-4, 4, -2)), ("N·s/kg", (1, -1, 0)),
     ("rad/m", (-1, 0, 0)), ("N·m/s", (2, -3, 1)), ("N m", (2, -2, 1)),
     ("-", (0, 0, 0)), ("", (0, 0, 0)), ("Hz", (0, -1, 0))],
)  # fmt: skip
def test_a_unit_is_its_powers(unit, powers):
    assert exponents(unit) == powers


@pytest.mark.parametrize("unit", ["furlong", "m/(s", "m^", "m^x", "B", "(m)(s)"])
def test_what_is_no_unit_is_refused(unit):
    with pytest.raises(ValueError, match="is no unit that is known"):
        exponents(unit)


def units(group):
    for entry in fields(group):
        if is_dataclass(getattr(group, entry.name, None)):
            yield from units(getattr(group, entry.name))
        elif "unit" in entry.metadata:
            yield from entry.metadata["unit"].split(", ")


def test_every_number_that_one_may_turn_has_a_unit_that_is_known():
    limits = JointLimits(*[np.ones(1)] * 4)
    for group in (WbcParameters(), PlannerParameters(), GroundSearch(), FilterNoise(), limits):
        found = list(units(group))
        assert found
        for unit in found:
            exponents(unit)
        floats = [
            entry.name
            for entry in fields(group)
            if isinstance(getattr(group, entry.name), float) and not entry.metadata
        ]
        assert not floats, f"without a unit: {floats}"


def test_every_metric_that_is_a_length_time_or_force_has_a_unit_that_is_known():
    unknown = set()
    for metric in OWN.values():
        try:
            exponents(metric.unit)
        except ValueError:
            unknown.add(metric.unit)
    assert unknown == {"B"}


def test_nothing_of_the_reference_robot_changes():
    assert Similarity.of(LEG_LENGTH * (1 + 1e-12), MASS * (1 - 1e-12)) == REFERENCE_SIZE
    assert REFERENCE_SIZE.scaled(WbcParameters()) == WbcParameters()
    for profile in PROFILES.values():
        assert REFERENCE_SIZE.scaled(profile.parameters) == profile.parameters
    assert all(REFERENCE_SIZE.factor(unit) == 1.0 for unit in ("m", "s", "kg", "1/(N·m)^2", "rad/m"))


def test_a_scaled_group_knows_its_size_and_keeps_what_has_no_unit():
    scaled = SIZE.scaled(PlannerParameters())
    assert scaled.size is SIZE
    assert (scaled.horizon, scaled.moves, scaled.solvers) == (
        50,
        PlannerParameters().moves,
        PlannerParameters().solvers,
    )
    assert math.isinf(scaled.search.hurry_after)


@pytest.mark.parametrize("length", [0.05, 0.25, 0.3, 0.5, 0.718, 0.9, 0.97, 1.5, 2.0, 4.0])
def test_times_are_the_root_of_lengths_at_whole_rates(length):
    time = Similarity(length).time
    assert time == pytest.approx(math.sqrt(length), rel=0.021)
    assert 50.0 / time == pytest.approx(round(50.0 / time), rel=1e-12)


@pytest.mark.parametrize("wrong", [0.0, -1.0, math.nan, math.inf])
def test_a_size_that_no_robot_has_is_refused(wrong):
    with pytest.raises(ParameterError, match="must be positive"):
        Similarity(wrong)
