"""Faults of another package are one sentence that names it, said to those alone who ask for what it brings."""

import json

import pytest

pytestmark = pytest.mark.unit

USES = {
    "surefoot.profiles": "planner.profile={}",
    "surefoot.estimators": "sensing.source={}",
    "surefoot.tasks": "wbc.tasks=[{}]",
    "surefoot.plants": "plant.name={}",
    "surefoot.controllers": "controller.name={}",
    "surefoot.robots": "robot={}",
    "surefoot.terrains": "terrain.kind={}",
    "surefoot.metrics": "criteria.{}=true",
}
"""A setting that asks for a name, by the group of its entry point."""

RIGHT = {
    "surefoot.profiles": "it must be a Profile",
    "surefoot.estimators": "it must be a function or a class",
    "surefoot.tasks": "it must be a function or a class",
    "surefoot.plants": "it must be a function or a class",
    "surefoot.controllers": "it must be a function or a class",
    "surefoot.robots": "it must be a Robot",
    "surefoot.terrains": "it must be a TerrainKind",
    "surefoot.metrics": "it must be a Metric",
}

OURS = {
    "surefoot.profiles": "paper",
    "surefoot.estimators": "truth",
    "surefoot.plants": "mujoco",
    "surefoot.controllers": "policy",
    "surefoot.robots": "humanoid100",
    "surefoot.terrains": "stairs",
}
"""A name of ours."""


@pytest.fixture
def broken(site):
    """A distribution whose module has nothing that is right."""
    made = site("broken-parts")
    made.write("broken/__init__.py", "NUMBER = 5\n")
    made.write("broken/bang.py", "print('hello')\nraise RuntimeError('no licence,\\n none')\n")
    made.write("broken/leaves.py", "import sys\nsys.exit(3)\n")
    return made


def refused(answer, *words):
    assert (answer.code, answer.out) == (2, ""), answer.err
    assert "Traceback" not in answer.err
    sentences = [line for line in answer.err.splitlines() if line != "hello"]
    assert len(sentences) == 1, sentences
    for word in words:
        assert word in sentences[0]


@pytest.mark.parametrize("group", USES)
def test_a_module_that_raises(broken, at_hand, group):
    broken.register(group, bang="broken.bang:THING")
    answer = at_hand("run", "diagonal-walk", "--set", USES[group].format("bang"), "--json", sites=[broken])
    reason = "cannot be loaded, RuntimeError: no licence, none; mend or remove it"
    refused(answer, f"'bang' of package broken-parts {reason}", "--set ")


@pytest.mark.parametrize("group", USES)
def test_an_object_of_another_kind(broken, at_hand, group):
    broken.register(group, five="broken:NUMBER")
    answer = at_hand("run", "diagonal-walk", "--set", USES[group].format("five"), sites=[broken])
    refused(answer, f"'five' of package broken-parts in {group} is of type int; {RIGHT[group]}")


def test_a_robot_that_cannot_be_loaded_leaves_nothing_to_say_of_its_bodies(broken, at_hand):
    broken.register("surefoot.robots", bang="broken.bang:THING")
    settings = ("--set", "robot=bang", "--set", "pushes=[{time: 1, force: [1, 0, 0], body: its_tail}]")
    refused(at_hand("run", "diagonal-walk", *settings, sites=[broken]), "'bang' of package broken-parts")


@pytest.mark.parametrize("target", ["broken.leaves", "broken.nowhere:X", "broken:NOTHING"])
def test_a_module_that_leaves_or_is_not_there(broken, at_hand, target):
    broken.register("surefoot.tasks", away=target)
    answer = at_hand("run", "diagonal-walk", "--set", "wbc.tasks=[away]", sites=[broken])
    refused(answer, "'away' of package broken-parts cannot be loaded")


@pytest.mark.parametrize("group", OURS)
def test_a_name_of_ours_means_ours_and_asking_for_it_is_refused(broken, at_hand, group):
    name = OURS[group]
    broken.register(group, **{name: "broken.bang:THING"})
    answer = at_hand("run", "diagonal-walk", "--set", USES[group].format(name), sites=[broken])
    refused(
        answer, f"'{name}' of package broken-parts in {group} has the name of one of surefoot's own; give it another"
    )


def test_a_name_of_two_packages(broken, site, at_hand):
    other = site("other-parts")
    other.write("other.py", "def task(model, frames): ...\n")
    other.register("surefoot.tasks", hand="other:task")
    broken.register("surefoot.tasks", hand="broken.bang:THING")
    answer = at_hand("run", "diagonal-walk", "--set", "wbc.tasks=[hand]", sites=[broken, other])
    refused(answer, "'hand' in surefoot.tasks is of packages", "broken-parts", "other-parts", "; remove one of them")


def test_a_class_where_an_object_is_wanted(documented, at_hand):
    documented.register("surefoot.terrains", moat="my_package.ground:Ditch")
    answer = at_hand("run", "walk", "--set", "terrain.kind=moat", sites=[documented])
    refused(answer, "'moat' of package my-package in surefoot.terrains is the class Ditch; register an instance of it")


def test_what_is_broken_and_not_asked_for_disturbs_nobody(broken, at_hand, tmp_path):
    """A metric alone is asked for by every verdict, and is a note beside it."""
    for group in (*USES, "surefoot.scenarios"):
        broken.register(group, bang="broken.bang:THING", five="broken:NUMBER", leaves="broken.leaves")
    broken.register("surefoot.metrics", fell="broken:NUMBER")
    keys = ("fidelity=pendulum", "gait.steps=2", "duration=0.2", "criteria={fell: false}")
    settings = [word for key in keys for word in ("--set", key)]
    answer = at_hand("run", "walk", *settings, "--json", "--out", str(tmp_path), sites=[broken])
    assert answer.code == 0, answer.err
    found = json.loads(answer.out)
    assert found["verdict"] == "pass"
    assert answer.err.splitlines() in ([], ["hello"], ["hello"] * 2)
    said = [note for note in found["notes"] if "broken-parts" in note]
    assert [note.split("'")[1] for note in said] == ["fell", "bang", "five", "leaves"]
    assert len(said) == len([note for note in found["notes"] if not note.startswith(("duration", "sensing.preset"))])
