"""Parts of another package are found by its entry point alone, and as good as our own."""

import csv
import json
import sys

import numpy as np
import pytest

from surefoot.scenarios.log import read
from surefoot.wbc.tasks import DEFAULT_LAYOUT

RIGHT = "install the package that brings it, again where its entry points have changed"
SHORT = ("--set", "duration=0.6", "--set", "criteria={fell: false, com_sway: {max: 0.1}}", "--json")


def ran(site, *arguments):
    """The JSON of a run, which passes."""
    done = site.run("run", *arguments)
    assert done.returncode == 0, (done.stdout, done.stderr)
    return json.loads(done.stdout)


@pytest.mark.unit
def test_a_robot_is_listed_beside_ours(disguised):
    listed = disguised.run("list").stdout.splitlines()
    robots = [line.split() for line in listed if line.startswith("robot ")]
    assert robots[0] == ["robot", "humanoid100"] and robots[-1] == ["robot", "disguised", "[disguised]"]


@pytest.mark.unit
def test_all_that_a_package_brings_is_listed_with_its_name_and_not_imported(documented, at_hand):
    documented.register("surefoot.profiles", bang="my_package.nowhere:X", paper="my_package.laws:PROFILE")
    code, out, err = at_hand("list", sites=[documented])
    brought = [line.split() for line in out.splitlines() if line.endswith("[my-package]")]
    assert {(kind, name) for kind, name, *_ in brought} == {
        *(("scenario", "two-slow-steps"), ("robot", "heavy"), ("terrain", "ditch"), ("estimator", "low-base")),
        *(("plant", "finer"), ("controller", "held"), ("instrument", "speedometer")),
        *(("profile", name) for name in ("spring", "calm", "patient", "bang")),
        ("task", "look-aside"),
        *(("metric", "com_sway"), ("metric", "torque_norm_rms")),
    }
    assert (code, err.count("\n")) == (0, 1)
    assert "'paper' of package my-package in surefoot.profiles has the name of one of surefoot's own" in err
    assert not {"my_package.laws", "my_package.metrics"} & set(sys.modules)
    found = json.loads(at_hand("list", "--json").out)
    assert {"name": "spring", "package": "my-package", "doc": ""} in found["profile"]
    assert {entry["package"] for entry in found["metric"]} == {"surefoot", "my-package"}


@pytest.mark.physics
def test_a_robot_whose_names_tell_nothing_walks_by_its_roles(disguised):
    found = ran(disguised, "diagonal-walk", "--set", "gait.steps=2", "--json", "--set", "robot=disguised")
    assert (found["verdict"], found["steps_taken"]) == ("pass", 2)


@pytest.mark.physics
def test_the_package_of_the_documentation_brings_all_at_once(documented, site):
    """Metric, law, task, estimator, robot and scenario; where the package is gone, their log is no pass."""
    found = ran(documented, "two-slow-steps", "--set", "planner={profile: spring, fading: 5}", *SHORT)
    assert 0.0 < found["com_sway"] < 0.1
    assert found["estimation_error_rms"] == pytest.approx(0.002, rel=0.05)
    path = documented.folder.parent / found["log"]
    assert json.loads(path.with_name("verdict.json").read_text())["com_sway"] == found["com_sway"]
    log = read(path)
    rows = sum(size for _, size in DEFAULT_LAYOUT)
    error = log["/wbc"].field("task_error")
    assert error.shape[1] == rows + 3
    assert np.all(np.any(error[:, rows:] != 0.0, axis=0))
    assert 'name="neck_yaw"' in log.attachments["robot.xml"].decode()

    elsewhere = site("elsewhere")
    seen = elsewhere.run("inspect", str(path), "--json")
    assert (seen.returncode, seen.stderr) == (1, "")
    reasons = json.loads(seen.stdout)["reasons"]
    places = ("robot 'heavy'", "planner.profile 'spring'", "sensing.source 'low-base'", "wbc.tasks.0 'look-aside'")
    assert reasons[:4] == [f"{place} is not known here; {RIGHT}" for place in places]
    assert reasons[4].startswith("com_sway is not known here")
    assert len(reasons) == 5
    again = elsewhere.run("run", str(path))
    assert (again.returncode, again.stdout) == (2, "")
    faults = [line.split(": ", 1)[1] for line in again.stderr.splitlines()]
    for fault, name in zip(faults, ("heavy", "spring", "low-base", "look-aside", "com_sway"), strict=True):
        assert f"'{name}'" in fault


@pytest.mark.physics
@pytest.mark.parametrize("profile", ["spring", pytest.param("calm", marks=pytest.mark.long)])
def test_planners_of_the_documentation_walk(documented, profile):
    found = ran(documented, "two-slow-steps", "--set", "gait.steps=1", "--set", f"planner.profile={profile}", "--json")
    assert found["steps_taken"] == 1


@pytest.mark.physics
def test_a_number_of_an_own_law_goes_through_run_log_check_and_processes_of_a_sweep(documented):
    """It moves the walk of two robots; a run of the log has it, a check, and each run of a sweep in two processes."""
    brief = ("two-slow-steps", "--set", "fidelity=pendulum", "--set", "duration=1", "--set", "criteria={fell: false}")
    own = ("--set", "planner.profile=spring", "--json")
    usual, slow = (ran(documented, *brief, *more, *own) for more in ((), ("--set", "planner.fading=1")))
    assert slow["zmp_error_rms"] != usual["zmp_error_rms"]
    g1 = ("walk-level", "--set", "robot=g1", *brief[1:])
    others = (ran(documented, *g1, *more, *own) for more in ((), ("--set", "planner.fading=1")))
    assert len({tuple(one["zmp_error_rms"]) for one in others}) == 2
    again = ran(documented, str(documented.folder.parent / slow["log"]), "--json")
    assert again["zmp_error_rms"] == slow["zmp_error_rms"]
    file = documented.folder.parent / "slow.yaml"
    file.write_text("fidelity: pendulum\nduration: 1\nplanner: {profile: spring, fading: 1}\ncriteria: {fell: false}\n")
    made = documented.run("check", str(file), "--update")
    assert made.returncode == 0, (made.stdout, made.stderr)
    assert "slow: same" in documented.run("check", str(file)).stdout
    file.write_text(file.read_text().replace("fading: 1", "fading: 2"))
    assert "fading" in documented.run("check", str(file)).stdout
    spec = documented.folder.parent / "fading.yaml"
    spec.write_text(
        "scenario: two-slow-steps\n"
        "set: {fidelity: pendulum, duration: 1, criteria: {fell: false}, planner.profile: spring}\n"
        "grid: {planner.fading: [1, 4]}\n"
    )
    done = documented.run("sweep", str(spec), "--jobs", "2", "--out", "swept")
    assert done.returncode == 0, (done.stdout, done.stderr)
    with (documented.folder.parent / "swept" / "table.csv").open() as file:
        swept = [float(row["zmp_error_rms.0 [m]"]) for row in csv.DictReader(file)]
    assert swept == pytest.approx([one["zmp_error_rms"][0] for one in (slow, usual)])


@pytest.mark.physics
def test_a_log_of_a_ditch_is_judged_where_nobody_knows_ditches(documented, site):
    keys = ("terrain={kind: ditch, riser: 0.1, tread: 0.15}", "gait.step_length=0.3", "duration=0.1", "criteria={}")
    done = documented.run("run", "diagonal-walk", *(word for key in keys for word in ("--set", key)), "--json")
    assert done.returncode == 0, done.stderr
    log = str(documented.folder.parent / json.loads(done.stdout)["log"])
    seen = json.loads(site("elsewhere").run("inspect", log, "--json").stdout)
    assert seen["reasons"] == [f"terrain.kind 'ditch' is not known here; {RIGHT}"]
    assert not [note for note in seen["notes"] if "terrain" in note]
