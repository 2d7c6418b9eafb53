"""A controller of another package takes the seat of planner and whole-body controller, by name in every command."""

import json

import pytest

from surefoot.scenarios.log import read


@pytest.mark.physics
@pytest.mark.parametrize("robot", ["humanoid100", "g1"])
def test_the_controller_of_the_page_stands(documented, robot):
    words = ("stand", "--set", f"robot={robot}", "--set", "duration=0.4", "--set", "criteria={fell: false}", "--json")
    done = documented.run("run", *words, "--policy", "held", "--set", "controller.options={stiffness: 5.0}")
    assert done.returncode == 0, done.stderr
    found = json.loads(done.stdout)
    folder = documented.folder.parent
    log = read(folder / found["log"])
    assert log.metadata["controller"] == {"name": "held", "stiffness": "5.0"}
    assert "/reference" not in log.topics and "/controller" not in log.topics
    again = documented.run("run", found["log"], "--json")
    assert again.returncode == 0, again.stderr
    other = read(folder / json.loads(again.stdout)["log"])
    assert (log["/truth"].field("q") == other["/truth"].field("q")).all()


@pytest.mark.unit
def test_one_that_nobody_brings_is_refused(at_hand):
    code, out, err = at_hand("run", "stand", "--set", "controller.name=held")
    assert (code, out) == (2, "")
    assert "'held'" in err and "Traceback" not in err
