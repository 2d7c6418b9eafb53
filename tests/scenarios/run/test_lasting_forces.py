"""Forces that go on, and a weight that is not believed in, in full physics: estimated, and walked with."""

import numpy as np
import pytest

from surefoot.scenarios.log import read
from surefoot.scenarios.run.run import run_scenario
from surefoot.scenarios.setup.load import load as load_scenario

NATURAL = (
    "gait.steps=7", "gait.step_length=0.36", "gait.single_support=0.5", "gait.double_support=0.12",
    "gait.com_height=0.95", "gait.initial_stand=0.4",
)  # fmt: skip
SURVIVED = "criteria={fell: false, steps_taken: steps_planned, wbc_fallbacks: {max: 0}, self_contact_time: {max: 0}}"
OFF = "sensing.force_estimate=false"
FORCES = {"forward": [1, 0], "left": [0, 1], "backward": [-1, 0], "right": [0, -1]}
HELD = {"natural gait": 40.0, "paper's gait, feet of 7.5 cm": 25.0}
"""Forces that are walked with in every direction and phase, by the walk [N]."""

LASTING = 2.0
"""Time for which each acts [s]."""

SCALES = (0.75, 0.8, 0.9, 1.1, 1.2, 1.25)
"""Ratios of the believed mass over the true one."""

PHASES = [("double", 0.5), ("single", 0.2), ("single", 0.5), ("single", 0.8)]


def walk(folder, scenario, *keys):
    return run_scenario(load_scenario(scenario, (SURVIVED, *keys)), folder)


def pulled(force, direction, phase=("single", 0.5)):
    x, y = np.multiply(FORCES[direction], force)
    place = f"step: 3, phase: {phase[0]}, fraction: {phase[1]}"
    return f"pushes=[{{{place}, duration: {LASTING}, force: [{x}, {y}, 0]}}]"


@pytest.mark.physics
def test_a_lasting_force_is_found_within_a_tenth_and_walked_with(tmp_path):
    # What is found of it from sensors shakes with their noise, see the next test.
    result = walk(tmp_path, "walk-level", *NATURAL, "sensing.source=truth", pulled(40, "left"))
    assert result.verdict.reasons == ()
    log = read(result.log)
    acting = log["/measurement"].field("external_force")[:, 1]
    began, ended = np.flatnonzero(acting > 39.0)[[0, -1]]
    found = log["/estimate"].field("external_force")
    np.testing.assert_allclose(found[began + 100 : ended, 1], 40.0, atol=4.0)
    assert np.abs(found[began + 100 : ended, 0]).max() < 4.0
    assert np.abs(found[:began]).max() == 0.0
    assert np.abs(found[ended + 100 :]).max() == 0.0
    # It acts on the torso, some 0.25 m over the CoM.
    assert np.median(log["/estimate"].field("external_moment")[began + 100 : ended, 0]) == pytest.approx(-9.6, abs=1.0)


@pytest.mark.physics
@pytest.mark.parametrize(
    ("direction", "phase", "seed"),
    [pytest.param("left", ("single", 0.5), 1, marks=pytest.mark.long), ("backward", ("double", 0.5), 2)],
)
def test_a_lasting_force_is_found_and_walked_with_from_sensors(direction, phase, seed, tmp_path):
    """Within a tenth in the median; what is found shakes with the noise of momentum and wrenches."""
    result = walk(tmp_path, "walk-level", *NATURAL, pulled(40, direction, phase), f"seed={seed}")
    assert result.verdict.reasons == ()
    log, along = read(result.log), np.array([*FORCES[direction], 0])
    acting = log["/measurement"].field("external_force") @ along
    began, ended = np.flatnonzero(acting > 39.0)[[0, -1]]
    found = log["/estimate"].field("external_force")
    lasting = found[began + 100 : ended]
    assert np.median(lasting @ along) == pytest.approx(40.0, abs=4.0)
    assert np.abs(lasting - 40.0 * along).max() < 16.0
    # No ghost before it acts, nor soon after it.
    assert np.linalg.norm(found[:began], axis=1).max() < 8.0
    assert np.linalg.norm(found[ended + 150 :], axis=1).max() < 8.0


@pytest.mark.physics
def test_a_force_that_is_walked_with_moves_steps_much_farther_without_the_estimate(tmp_path):
    """Steps alone then catch a body that leans the wrong way, one after the other."""
    told = walk(tmp_path, "walk-level", *NATURAL, pulled(45, "left")).verdict
    untold = walk(tmp_path, "walk-level", *NATURAL, pulled(45, "left"), OFF).verdict
    assert told.reasons == ()
    assert untold.metrics["step_shift"] > 0.25 > 2.5 * told.metrics["step_shift"]


@pytest.mark.physics
def test_an_undisturbed_walk_is_the_same_to_the_last_digit(tmp_path):
    logs = [
        read(walk(tmp_path, "walk-level", *NATURAL, "gait.steps=2", "duration=2.5", *keys).log) for keys in ((), (OFF,))
    ]
    np.testing.assert_array_equal(*(log["/truth"].field("q") for log in logs))
    estimate = logs[0]["/estimate"]
    assert not estimate.field("external_force").any()
    assert not estimate.field("external_moment").any()
    assert len(set(estimate.field("mass"))) == 1


@pytest.mark.physics
@pytest.mark.parametrize("scale", [0.75, 1.25])
@pytest.mark.parametrize("keys", [("sensing.source=truth",), ()], ids=["truth", "good"])
def test_the_true_weight_is_found_within_a_hundredth(scale, keys, tmp_path):
    log = read(walk(tmp_path, "stand", f"errors.mass_scale={scale}", "duration=0.8", *keys).log)
    np.testing.assert_allclose(log["/estimate"].field("mass")[100:], 100.0 / scale, rtol=0.01)


@pytest.mark.long
@pytest.mark.parametrize("phase", PHASES)
@pytest.mark.parametrize("direction", FORCES)
@pytest.mark.parametrize("keys", [("sensing.source=truth",), ()], ids=["truth", "good"])
def test_forces_that_last_two_seconds(keys, direction, phase, tmp_path):
    keys = (*NATURAL, pulled(HELD["natural gait"], direction, phase), "start.position_noise=0.0005", *keys)
    assert walk(tmp_path, "walk-level", *keys).verdict.reasons == ()


@pytest.mark.long
@pytest.mark.parametrize("phase", PHASES)
@pytest.mark.parametrize("direction", FORCES)
def test_forces_that_last_on_small_feet(direction, phase, tmp_path):
    force = HELD["paper's gait, feet of 7.5 cm"]
    keys = (pulled(force, direction, phase), "gait.initial_stand=0.4", "start.position_noise=0.0005", "duration=18.0")
    assert walk(tmp_path, "diagonal-walk", *keys).verdict.reasons == ()


@pytest.mark.long
@pytest.mark.parametrize("scenario", ["walk-level", "diagonal-walk"])
@pytest.mark.parametrize("scale", SCALES)
def test_a_weight_that_is_not_believed_in(scale, scenario, tmp_path):
    assert walk(tmp_path, scenario, f"errors.mass_scale={scale}").verdict.reasons == ()
