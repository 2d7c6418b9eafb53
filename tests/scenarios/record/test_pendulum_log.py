"""The log of a pendulum is of one piece: forces, centres of pressure, the clock of the gait, the times of a tick."""

import time

import numpy as np
import pytest

import surefoot
from surefoot.planner.geometry.plane import headings
from surefoot.similarity import GRAVITY

pytestmark = pytest.mark.unit


@pytest.fixture(scope="module")
def walked(tmp_path_factory):
    """The log of a walk that turns, and the time that it took [s]."""
    begin = time.perf_counter()
    shorter = {"duration": 4.0, "gait.apex_single": 0.02}
    scenario = surefoot.load("walk-turn", {"fidelity": "pendulum", "criteria": {"fell": False}, **shorter})
    result = surefoot.run(scenario, out=tmp_path_factory.mktemp("pendulum"))
    took = time.perf_counter() - begin
    return surefoot.read(result.log), took


def test_normal_forces_carry_and_accelerate_the_mass(walked):
    reference, contact = (walked[0][topic] for topic in ("/reference", "/contact"))
    forces, weight = contact.field("normal_force"), GRAVITY + reference.field("com_acceleration")[:, 2]
    np.testing.assert_allclose(forces.sum(axis=1) / forces[0].sum(), weight / weight[0], rtol=1e-6)
    assert (forces > -1e-9).all() and np.ptp(weight) > 0.1


def test_the_centre_of_pressure_of_one_foot_is_the_zmp_as_its_sole_sees_it(walked):
    truth, contact = (walked[0][topic] for topic in ("/truth", "/contact"))
    for name in ("left", "right"):
        cop, sole = contact.field(f"cop_{name}"), truth.field(f"{name}_sole")
        stands = np.isfinite(cop[:, 0])
        yaw, place = headings(sole[stands, 3:]), sole[stands, :2]
        x, y = cop[stands].T
        ways = np.column_stack((np.cos(yaw) * x - np.sin(yaw) * y, np.sin(yaw) * x + np.cos(yaw) * y))
        np.testing.assert_allclose(place + ways, contact.field("zmp")[stands, :2], atol=1e-9)
        assert stands.any() and np.abs(yaw).max() > 0.1


def test_the_clock_of_a_phase_goes_with_time_and_begins_anew_with_the_next_one(walked):
    reference = walked[0]["/reference"]
    elapsed, duration = reference.field("phase_time"), reference.field("phase_duration")
    gone, passed = np.diff(elapsed), np.diff(1e-9 * reference.time_ns)
    same = gone > 0.0
    np.testing.assert_allclose(gone[same], passed[same], atol=1e-9)
    assert (elapsed >= 0.0).all() and (elapsed <= duration + 1e-9).all()
    assert 3 < (~same).sum() < 0.01 * len(same) and (elapsed[1:][~same] < 0.03).all()


def test_parts_of_a_tick_take_no_longer_than_the_tick_and_all_no_longer_than_the_run(walked):
    log, took = walked
    timing = log["/timing"]
    parts = sum(timing.field(name) for name in ("state", "wbc_build", "wbc_solve", "planner", "physics", "log"))
    for name in ("state", "planner", "physics", "log", "tick"):
        assert (timing.field(name) >= 0.0).all()
    assert (parts <= timing.field("tick") + 1e-3).all()
    assert timing.field("tick").sum() < 1e6 * took


def test_the_zmp_lies_on_the_ground_between_the_soles(tmp_path):
    keys = {"fidelity": "pendulum", "terrain.kind": "blocks", "terrain.riser": 0.05, "duration": 0.2}
    log = surefoot.read(surefoot.run(surefoot.load("stand", keys), out=tmp_path).log)
    soles = [log["/truth"].field(f"{name}_sole")[:, 2] for name in ("left", "right")]
    share = log["/contact"].field("normal_force")
    share = share / share.sum(axis=1)[:, None]
    assert np.min(soles) > 0.05 and share.min() > 0.1
    np.testing.assert_allclose(log["/contact"].field("zmp")[:, 2], share[:, 0] * soles[0] + share[:, 1] * soles[1])
