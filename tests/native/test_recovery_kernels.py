"""Capture margin and step adjustment by kernels against plain Python, on steps drawn at random."""

from dataclasses import replace

import numpy as np
import pytest

from surefoot.native.library import VARIABLE
from surefoot.planner.model.dcm import nominal_dcm
from surefoot.planner.recovery.capture_margin import CaptureMargin, PlannedMargin
from surefoot.planner.recovery.step_adjustment import StepAdjustment, StepProblem
from surefoot.planner.swing.leg_reach import ANYWHERE
from surefoot.planner.types import Foot, Footstep
from surefoot.scenarios.log import NoLog
from surefoot.scenarios.run.run import closed_loop
from surefoot.scenarios.setup.load import load
from surefoot.scenarios.setup.walk import resolve

pytestmark = pytest.mark.unit

ADAPTATIONS = ("location", "timing", "crossing")


def a_step(rng, window):
    """A next step of any kind, with CoM and DCM, which is near or far from what the window keeps bounded."""
    side, double = rng.choice([-1.0, 1.0]), rng.choice([0.0, rng.uniform(0.02, 0.3)])
    nominal = np.array([rng.uniform(-0.3, 0.4), side * rng.uniform(0.15, 0.35)])
    here = np.array([rng.uniform(-0.4, 0.4), side * rng.uniform(-0.2, 0.35)])
    face = ANYWHERE if rng.random() < 0.5 else nominal + np.array([[-0.1, -0.05], [0.15, 0.1]])
    turn = rng.choice([0.0, rng.uniform(-0.4, 0.4)])
    step = StepProblem(
        place=Footstep(Foot.LEFT if side > 0.0 else Foot.RIGHT, np.append(nominal, 0.0), turn),
        swing=np.stack((here, rng.uniform(-1.5, 1.5, 2))),
        double=double,
        single=rng.uniform(0.05, 0.8),
        cycle=rng.uniform(0.4, 1.0),
        shortest=rng.choice([0.0, rng.uniform(0.0, 0.5)]),
        face=face,
        crosses=bool(rng.random() < 0.7),
        last=bool(rng.random() < 0.3),
        adapted=bool(rng.random() < 0.5),
    )
    bounded = nominal_dcm(window.stiffness, window.omega, window.driving.point, 0.02)[0]
    dcm = bounded + rng.choice([0.02, 0.5]) * rng.uniform(-1.0, 1.0, 2)
    return dcm + rng.uniform(-0.2, 0.2, 2), dcm, step


@pytest.fixture
def made(kernels, monkeypatch):
    """Margin and adjustment by plain Python and by kernels, with a window."""

    def make(adaptation):
        planner = closed_loop(resolve(load("walk", {"planner.step_adaptation": adaptation})), NoLog()).planning.planner
        execution, legs, parameters = planner._execution, planner._execution.legs, planner.parameters
        for _ in range(180):
            execution.clock = execution.clock.advanced()
        execution.follow(execution.schedule)
        window = planner._preview.window(execution, planner._preview.support(execution), np.zeros(2), 3.6)
        found = []
        for native in ("0", "1"):
            monkeypatch.setenv(VARIABLE, native)
            margin = CaptureMargin(legs, parameters, np.array([0.11, 0.05]))
            found.append((margin, StepAdjustment(legs, parameters)))
        assert [margin._compiled is None for margin, _ in found] == [True, False]
        return found, window

    return make


@pytest.mark.parametrize("adaptation", ADAPTATIONS)
def test_margins_are_those_of_plain_python(made, adaptation):
    ((plain, _), (compiled, _)), window = made(adaptation)
    rng, omega, seen = np.random.default_rng(1), float(window.omega[0]), set()
    for _ in range(150):
        com, dcm, step = a_step(rng, window)
        given = com, dcm, omega, step, int(rng.integers(1, 6)), bool(rng.random() < 0.3)
        one, other = plain.margins(*given), compiled.margins(*given)
        np.testing.assert_allclose(other, one, rtol=1e-11, atol=1e-11)
        seen |= {(one[-1] > 0.0, given[-1])}
    assert {fixed for _, fixed in seen} == {True, False}


@pytest.mark.parametrize("adaptation", ADAPTATIONS)
def test_steps_are_adjusted_as_by_plain_python(made, adaptation):
    ((_, plain), (_, compiled)), window = made(adaptation)
    rng, seen = np.random.default_rng(2), set()
    for number in range(250):
        com, dcm, step = a_step(rng, window)
        unsure = 0.01 * (number % 5 == 0)
        one, other = (adjustment.solve(com, dcm, window, step, unsure) for adjustment in (plain, compiled))
        assert (one is None) is (other is None)
        if one is not None:
            np.testing.assert_allclose(other.box, one.box, rtol=1e-9, atol=1e-11)
            np.testing.assert_allclose(other.left, one.left, rtol=1e-12)
            assert other.more is one.more
            seen |= {("other time", one.left not in (step.double, step.single)), ("more", one.more)}
            seen |= {("crosses", bool((step.place.foot.side * one.box[:, 1] < 0.0).all()))}
    assert ("more", True) in seen
    assert (("more", False) in seen) is (("other time", True) in seen)
    assert (("other time", True) in seen) is (adaptation != "location")
    assert (("crosses", True) in seen) is (adaptation == "crossing")


@pytest.mark.parametrize("length", [None, 100])
def test_the_dcm_that_a_window_keeps_bounded_is_that_of_plain_python(made, monkeypatch, length):
    _, window = made("crossing")
    parameters = resolve(load("walk")).parameters
    monkeypatch.delenv(VARIABLE)
    window = replace(
        window,
        driving=window.driving.part(slice(length)),
        stiffness=window.stiffness[:length],
        omega=window.omega[:length],
    )
    compiled = PlannedMargin(parameters)
    monkeypatch.setenv(VARIABLE, "0")
    plain = PlannedMargin(parameters)
    assert (plain.outlook is None, compiled.outlook is None) == (True, False)
    found, wanted = compiled.nominal(window), plain.nominal(window)
    np.testing.assert_allclose(found, wanted, rtol=1e-12, atol=1e-13)
    later = window.driving.point[-1]
    assert np.abs(found - later).max() > 0.01


def test_kernels_step_aside_for_a_window_of_another_length(made):
    ((_, plain), (_, compiled)), window = made("crossing")
    short = replace(
        window,
        driving=window.driving.part(slice(100)),
        stiffness=window.stiffness[:100],
        omega=window.omega[:100],
    )
    com, dcm, step = a_step(np.random.default_rng(3), window)
    one, other = (adjustment.solve(com, dcm, short, step) for adjustment in (plain, compiled))
    np.testing.assert_array_equal(one.box, other.box)
