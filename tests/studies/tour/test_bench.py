"""The bench keeps tours as they come and goes on with those of the same making alone."""

import json
import re

import mujoco
import numpy as np
import pytest
from typer.testing import CliRunner

from surefoot.scenarios.cli.program import app
from surefoot.scenarios.errors import ScenarioError
from surefoot.studies.tour import bench as module
from surefoot.studies.tour.bench import Bench, lines
from surefoot.studies.tour.page import markdown
from surefoot.studies.tour.ride import Ride, TourResult
from surefoot.studies.tour.robot import tour_robot
from surefoot.studies.tour.rows import DRIVES, ROWS, command_to

pytestmark = pytest.mark.unit


def made_up(entrant, seed, duration, setting):
    return TourResult(entrant.name, seed, min(10.0 + seed, duration), False, (0.01,), (0.02,), (300.0,), (), "", 0, 0.3)


@pytest.fixture
def ran(monkeypatch):
    ran = []

    def side_by_side(work, arguments, jobs, lost):
        for given in arguments:
            ran.append(given)
            yield made_up(*given)

    monkeypatch.setattr(module, "side_by_side", side_by_side)
    return ran


def test_it_goes_on_where_it_stopped(ran, tmp_path):
    first = Bench([ROWS["torque"]], 3, tmp_path)
    first.run(1)
    again = Bench([ROWS["torque"]], 5, tmp_path)
    assert [seed for _, seed, *_ in again.left()] == [3, 4]
    again.run(1)
    assert [seed for _, seed, *_ in ran] == [0, 1, 2, 3, 4]
    assert again.rows()[0].survival.value == pytest.approx(12.0)


def test_tours_of_another_length_or_of_other_code_are_run_again(ran, tmp_path):
    Bench([ROWS["torque"]], 2, tmp_path).run(1)
    assert len(Bench([ROWS["torque"]], 2, tmp_path, duration=20.0).left()) == 2
    journal = tmp_path / module.JOURNAL
    told = [json.loads(line) for line in journal.read_text().splitlines()]
    journal.write_text(json.dumps({**told[0], "made_by": "others"}) + "\n" + json.dumps(told[1]) + "\n{half")
    assert [seed for _, seed, *_ in Bench([ROWS["torque"]], 2, tmp_path).left()] == [0]


def test_the_result_is_whole_and_tells_what_it_is(ran, tmp_path):
    bench = Bench([ROWS["torque"]], 4, tmp_path)
    bench.run(1)
    told = json.loads(bench.write().read_text())
    assert told["note"].startswith("Own implementation.")
    assert told["differences"] and told["source"] and told["versions"]["mujoco"]
    page = (tmp_path / module.PAGE).read_text()
    assert page == markdown(told)
    assert (
        "| `torque` | 4 | 11.5 (" in page and "| gr00t_wbc h066_p000 | 85.2 | 80 % |" in page and told["note"] in page
    )
    text = "\n".join(lines(told))
    assert "11.5" in text and "gr00t_wbc" in text and told["note"] in text


@pytest.mark.parametrize(
    ("words", "told"),
    [
        (["g1-tour", "--row", "torqe"], "g1-tour: no row 'torqe'; did you mean 'torque'?"),
        (["g1-tours"], "there is no benchmark 'g1-tours'; did you mean 'g1-tour'?"),
    ],
)
def test_what_is_not_there_is_refused(words, told):
    done = CliRunner().invoke(app, ["bench", *words])
    assert isinstance(done.exception, ScenarioError)
    assert str(done.exception) == told


def test_the_velocity_to_a_place_is_bounded_and_never_stands():
    far, there = command_to((9.0, -9.0), 3.0), command_to((0.0, 0.0), 0.0)
    assert far.twist.x > 0.0 > far.twist.y and far.twist.yaw > 0.0
    assert command_to((99.0, -99.0), 9.0) == far
    assert there.twist.is_zero and there.march and far.march


@pytest.mark.parametrize("row", ROWS)
def test_a_tour_begins_on_its_feet_and_is_the_same_each_time(row):
    rides = [Ride(ROWS[row], 1) for _ in range(2)]
    results = [ride.run(0.5) for ride in rides]
    assert results[0] == results[1] and results[0].completed
    assert len(results[0].punches) == 1 and results[0].punches[0].survived
    assert rides[0].world.pelvis[2] > 0.7


def test_the_controller_is_told_the_drives_of_the_arms_as_they_are():
    robot, description = tour_robot(), ROWS["arms"].controller().walk.robot
    armature = mujoco.MjModel.from_xml_string(description.mjcf).dof_armature[6:]
    arms = {}
    for pattern, gains in DRIVES.items():
        arms |= dict.fromkeys((name for name in description.joint_names if re.fullmatch(pattern, name)), gains)
    assert len(arms) == 14
    for name, inertia in zip(description.joint_names, armature, strict=True):
        if name in arms:
            assert arms[name] == pytest.approx(robot.drive_gains(inertia), abs=1e-4)


def test_the_contract_hands_over_no_place_and_no_speed_of_the_base():
    ride = Ride(ROWS["contract"], 0)
    ride.step()
    seen, true = ride.world.contracted(), ride.world.measure()
    assert np.isnan(seen.q[:3]).all() and np.isnan(seen.v[:3]).all() and np.isnan(seen.wrench).all()
    assert np.isnan(seen.accelerometer).all()
    assert np.array_equal(seen.q[3:], true.q[3:]) and np.array_equal(seen.v[3:], true.v[3:])
