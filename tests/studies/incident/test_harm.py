"""Two falls are the same where they come at about the time and the same way; a missed criterion is an incident too."""

import numpy as np
import pytest
import yaml

import surefoot
from surefoot.scenarios.errors import LogError
from surefoot.scenarios.file.criteria import Bound
from surefoot.studies.incident import report
from surefoot.studies.incident.harm import SAME_TIME, SAME_WAY, Harm, harm_of, likeness
from surefoot.studies.incident.regression import Incident, Trials, criteria_of, regression, write

pytestmark = pytest.mark.unit


def fall(time=2.0, angle=0.0, length=0.3):
    way = length * np.array([np.cos(np.radians(angle)), np.sin(np.radians(angle))])
    return Harm(time, way, (), SAME_TIME)


@pytest.mark.parametrize(
    ("other", "same"),
    [
        (fall(2.0), True),
        (fall(2.0 + 0.9 * SAME_TIME), True),
        (fall(2.0 + 1.1 * SAME_TIME), False),
        (fall(2.0 - 1.1 * SAME_TIME), False),
        (fall(angle=0.9 * SAME_WAY), True),
        (fall(angle=-0.9 * SAME_WAY), True),
        (fall(angle=1.1 * SAME_WAY), False),
        (fall(angle=180.0), False),
        (fall(angle=180.0, length=1e-6), True),
        (None, False),
        (Harm(2.0, None, ("foot_slip_max",), SAME_TIME), False),
        (Harm(2.0, None, (), SAME_TIME, "not finite"), False),
    ],
)
def test_a_fall_is_the_same_by_time_and_way(other, same):
    assert fall().same(other) is same


def test_missed_criteria_are_the_same_where_one_is():
    one = Harm(5.0, None, ("foot_slip_max", "speed_mean"), SAME_TIME)
    assert one.same(Harm(3.0, None, ("speed_mean",), SAME_TIME))
    assert not one.same(Harm(5.0, None, ("zmp_error_rms",), SAME_TIME))
    assert not one.same(fall(5.0))


def test_faults_are_the_same_at_about_the_time():
    one = Harm(2.0, None, (), SAME_TIME, "not finite")
    assert one.same(Harm(2.1, None, (), SAME_TIME, "diverged"))
    assert not one.same(Harm(2.0 + 2.0 * SAME_TIME, None, (), SAME_TIME, "not finite"))
    assert not one.same(Harm(2.0, None, ("speed_mean",), SAME_TIME))


@pytest.fixture(scope="module")
def pendulum(tmp_path_factory):
    """Runs of a pendulum: it walks, is pushed over, is pushed a little later, and is pushed over as it stands."""
    folder, found = tmp_path_factory.mktemp("pendulum"), {}
    for name, pushes in {"walks": [], "falls": [1.6], "later": [1.62], "stands": [0.3]}.items():
        push = [{"time": time, "impulse": 3.0, "duration": 0.1} for time in pushes]
        values = {"fidelity": "pendulum", "gait.steps": 3, "pushes": push, "criteria": {"fell": False}}
        scenario = surefoot.load("walk-level", values)
        found[name] = surefoot.read(surefoot.run(scenario, out=folder / name).log)
    return found


def test_the_harm_of_a_log(pendulum):
    fallen = harm_of(pendulum["falls"], {})
    assert fallen is not None
    assert fallen.fell
    assert fallen.time == pytest.approx(float(pendulum["falls"].metadata["end"]["time"]))
    stood = harm_of(pendulum["stands"], {})
    assert stood is not None
    assert stood.way[0] > 0.1 > 10.0 * abs(stood.way[1])  # the push is forward
    assert harm_of(pendulum["walks"], {"fell": Bound(equals=False)}) is None
    criteria = {"speed_mean": Bound(min=10.0), "real_time_factor": Bound(min=1e9), "fell": Bound(equals=False)}
    missed = harm_of(pendulum["walks"], criteria)
    assert missed is not None
    assert (missed.fell, missed.missed) == (False, ("speed_mean",))


def test_likeness_is_of_the_motion_until_the_fall(pendulum):
    one = harm_of(pendulum["falls"], {})
    same = likeness(pendulum["falls"], one, pendulum["falls"], one)
    assert (same.parts, same.distance, same.later) == (None, 0.0, 0.0)
    other = harm_of(pendulum["later"], {})
    found = likeness(pendulum["falls"], one, pendulum["later"], other)
    assert found.parts == pytest.approx(1.6, abs=0.003)
    assert found.distance > 1e-3
    assert found.later == pytest.approx(other.time - one.time)
    assert "to the bit" in same.text
    assert "to the bit" not in found.text


def test_a_pendulum_comes_back_smaller_and_its_scenario_is_one_that_any_command_reads(pendulum, tmp_path):
    scenario = surefoot.load(
        "walk-level",
        {
            "fidelity": "pendulum",
            "gait.steps": 3,
            "sensing.com_noise": 0.0005,
            "pushes": [{"time": 0.3, "impulse": 0.05}, {"time": 1.6, "impulse": 3.0}],
        },
    )
    incident = Incident.of(surefoot.run(scenario, out=tmp_path).log)
    trials = Trials(incident, "small")
    found = regression(incident, trials)
    assert found.comes_back
    assert found.again.likeness.parts is None
    assert [cause.keys for cause in found.needed] == [(("pushes", 1),)]
    assert len(found.causes) == 5  # both pushes, the estimator, its sensors, and the noise
    path = tmp_path / "small.yaml"
    write(found, path, report.comment(found, path))
    keys = yaml.safe_load(path.read_text())
    assert [push["time"] for push in keys["pushes"]] == [1.6]
    assert keys["criteria"] == {"fell": False}
    assert trials.of_file(path).same
    assert surefoot.load(str(path)).duration == pytest.approx(incident.harm.time + 2.0)
    lines = list(report.lines(found, path, trials.of_file(path)))
    assert any("not needed" in line and "com_noise" in line for line in lines)
    assert any("pushes=[]" in line for line in lines)


def test_a_log_without_an_incident_is_refused(pendulum):
    with pytest.raises(LogError, match="shows no incident"):
        Incident.of(pendulum["walks"].path)


def test_a_missed_criterion_comes_back(tmp_path):
    scenario = surefoot.load(
        "walk-level",
        {"fidelity": "pendulum", "gait.steps": 2, "criteria": {"speed_mean": {"min": 5.0}}, "sensing.com_noise": 1e-4},
    )
    incident = Incident.of(surefoot.run(scenario, out=tmp_path).log)
    found = regression(incident, Trials(incident, "slow"))
    assert incident.harm.missed == ("speed_mean",)
    assert criteria_of(incident) == {"fell": False, "speed_mean": {"min": 5.0}}
    assert (found.comes_back, found.needed) == (True, ())
