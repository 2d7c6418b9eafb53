"""Around `walk-brisk`: other steps, timings, grounds and starts, with the same margins but for the speed."""

import math

import numpy as np
import pytest
from variations import SOUND

from surefoot.scenarios.log import read
from surefoot.scenarios.run.run import run_scenario
from surefoot.scenarios.setup.load import load as load_scenario

NOISE = ("start.position_noise=0.001", f"start.angle_noise={math.radians(1.0)}")
VARIED = (
    *(f"gait.step_length={v}" for v in (0.45, 0.5, 0.55)),
    *(f"gait.single_support={v}" for v in (0.38, 0.44, 0.5)),
    *(f"gait.double_support={v}" for v in (0.08, 0.12, 0.16)),
    "gait.com_height=0.9", "gait.swing_height=0.03", "gait.swing_height=0.08", "gait.step_width=0.25",
    "terrain.friction=0.6", "rates.control=1000", "gait.turn=0.03",
)  # fmt: skip


@pytest.mark.long
@pytest.mark.parametrize("overrides", [*((v,) for v in VARIED), *((*NOISE, f"seed={v}") for v in range(4))], ids=str)
def test_neighbours_walk(tmp_path, overrides):
    criteria = (SOUND.replace("footstep_error_max: {max: 0.01}, ", ""), "criteria.speed_mean={min: 0.8}")
    verdict = run_scenario(load_scenario("walk-brisk", [*overrides, *criteria]), tmp_path).verdict
    assert verdict.reasons == ()


@pytest.mark.physics
def test_heel_off_saves_work_and_torque(tmp_path, from_sensors):
    (flat, _), (rolled, log) = (_walked(f"gait.heel_off={angle}", tmp_path) for angle in (0.0, 0.6))
    assert flat.reasons == rolled.reasons == ()
    assert rolled.metrics["foot_slip_max"] < 0.003
    assert rolled.metrics["stance_tilt_max"] < 0.02 < log["/reference"].field("roll").max()
    assert rolled.metrics["cost_of_transport"] < 0.85 * flat.metrics["cost_of_transport"]
    # The logged reference of a rolling foot is of the sole's centre, as what is measured of it; the foot is where it is
    # planned half a tick later. From sensors it is planned in a world that has drifted by a millimetre.
    planned, stance = log["/reference"].field("swing_position"), log["/reference"].field("stance")
    later = 0.5 * (planned[:-1] + planned[1:])
    for foot, name in enumerate(("left_sole", "right_sole")):
        swings = (stance[:-1] == 1 - foot) & (stance[1:] == 1 - foot)
        error = (later - log["/estimation" if from_sensors else "/truth"].field(name)[:-1, :3])[swings]
        assert np.linalg.norm(error, axis=1).max() < 0.006


def _walked(override, folder):
    overrides = ("gait.steps=7", "gait.initial_stand=0.2", "criteria.speed_mean={min: 0.8}", override)
    result = run_scenario(load_scenario("walk-brisk", overrides), folder)
    return result.verdict, read(result.log)


@pytest.mark.physics
def test_feet_that_land_on_their_heels_save_knees_and_work(tmp_path, from_sensors):
    """At 0.75 m/s, with the CoM higher by as much as straighter front legs allow."""
    gait = ("gait.step_length=0.44", "gait.single_support=0.42", "gait.double_support=0.12", "gait.heel_off=0.5")
    criteria = (
        "criteria={fell: false, steps_taken: steps_planned, wbc_fallbacks: {max: 0}, foot_slip_max: {max: 0.005}}"
    )
    flat, rolled = (
        run_scenario(load_scenario("walk-level", ("gait.steps=9", *gait, *more, criteria)), tmp_path / more[0])
        for more in (("gait.com_height=1.0",), ("gait.com_height=1.01", "gait.heel_strike=0.2"))
    )
    assert flat.verdict.reasons == rolled.verdict.reasons == ()
    level, heels = flat.verdict.metrics, rolled.verdict.metrics
    assert abs(level["heel_strike_pitch"]) < 0.01 and 0.17 < heels["heel_strike_pitch"] < 0.21
    assert heels["stance_tilt_max"] < 0.01 and heels["footstep_error_max"] < 0.015
    assert heels["knee_stance_mean"] < level["knee_stance_mean"] - 0.1
    assert heels["knee_heel_strike"] < level["knee_heel_strike"]
    assert heels["cost_of_transport"] < 0.9 * level["cost_of_transport"]
    assert heels["landing_peak"] < 1.7
    log = read(rolled.log)
    assert log["/reference"].field("roll").min() < -0.19
    # Both feet roll at once, which is where the estimator has no sole that stands still but edges that do.
    edges = log["/contact"].field("edge")
    assert ((edges[:, 0] * edges[:, 1]) == -1).mean() > 0.02
    if from_sensors:
        assert heels["estimation_nees"]["sole_height"] < 4.0
