"""A plant of another package: in a run, a campaign in other processes, and a log that is run again, of two robots."""

import json

import pytest

from surefoot.scenarios.log import read

G1 = ("--set", "robot=g1", "--set", "sized_for=humanoid100")
LOW = ("--set", "criteria={fell: false, steps_taken: {min: 2}}")
FINER = ("--set", "plant.name=finer", "--set", "gait.steps=2", "--set", "sensing.source=truth")


@pytest.mark.unit
@pytest.mark.parametrize(
    "robot", [pytest.param((), id="humanoid100", marks=pytest.mark.long), pytest.param(G1, id="g1")]
)
def test_a_run_with_it_passes_and_its_log_walks_again(documented, robot):
    done = documented.run("run", "walk", *FINER, *robot, *LOW, "--json")
    assert done.returncode == 0, (done.stdout, done.stderr)
    found = json.loads(done.stdout)
    path = documented.folder.parent / found["log"]
    again = documented.run("run", str(path), "--json")
    assert again.returncode == 0, (again.stdout, again.stderr)
    twice = json.loads(again.stdout)
    told = [read(documented.folder.parent / one["log"])["/truth"].field("q") for one in (found, twice)]
    assert (told[0] == told[1]).all()


@pytest.mark.unit
def test_a_campaign_with_it_walks_in_other_processes(documented, tmp_path):
    spec = tmp_path / "spec.yaml"
    spec.write_text(
        "about: two plants\nscenario: walk\n"
        "set: {plant.name: finer, sensing.source: truth, gait.steps: 1, duration: 0.5, criteria: {fell: false}}\n"
        "grid:\n  plant:\n    coarse: {plant.options.refined: 1}\n    fine: {plant.options.refined: 3}\n"
    )
    done = documented.run("sweep", str(spec), "--jobs", "2", "--out", str(tmp_path / "swept"))
    assert done.returncode == 0, (done.stdout, done.stderr)


REFUSED = {
    ("plant.options={refined: 2}",): "plant.options of the simulated world, which takes none: refined",
    ("plant.name=finer", "sensing.source=ekf"): "an estimator that senses, of a plant without a method read",
    ("plant.name=finer", "pushes=[{time: 1, force: [10, 0, 0]}]"): "pushes of a plant without a method push",
    ("plant.name=unheard",): "finer",
}


@pytest.mark.unit
@pytest.mark.parametrize("settings", REFUSED, ids=" ".join)
def test_what_it_cannot_do_is_refused_in_one_sentence(documented, at_hand, settings):
    words = [word for setting in settings for word in ("--set", setting)]
    code, out, err = at_hand("run", "walk", *words, sites=[documented])
    assert (code, out) == (2, ""), err
    assert "Traceback" not in err
    assert err.count("\n") == 1
    assert REFUSED[settings] in err


@pytest.mark.unit
def test_on_a_pendulum_it_has_no_effect(at_hand):
    _, out, err = at_hand(
        "run", "walk", "--set", "plant.name=mujoco", "--set", "fidelity=pendulum", "--set", "duration=0.1"
    )
    assert "plant has no effect on a pendulum" in out + err
