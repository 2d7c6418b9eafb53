"""A part of another package that fails in use: the run ends as a fault that names it, with an exit code of ours."""

import json

import pytest

from surefoot.scenarios.log import read

PARTS = """
import os
import sys

import numpy as np

from surefoot.joints import JointCommand
from surefoot.models import Robot, RobotDescription, RobotOptions
from surefoot.planner import Motion, PlannerParameters, Profile, WalkingPlanner
from surefoot.planner.laws.footstep_tvmpc import FootstepTvmpc
from surefoot.scenarios.judge.metric import metric
from surefoot.scenarios.setup.terrain import TerrainKind
from surefoot.sim import Measurement
from surefoot.wbc import RobotState


class Root(BaseException):
    pass


class Mute(Exception):
    def __str__(self):
        sys.exit(0)


def deep():
    return deep()


def fail(how):
    if how == "leaves":
        sys.exit(0)
    if how == "root":
        raise Root("of all")
    if how == "mute":
        raise Mute
    if how == "deep":
        deep()
    if how == "dies":
        os._exit(0)
    return how


class Task:
    name, size, weight = "arm up", 3, 1.0

    def __init__(self, how):
        self.how = how

    def write(self, terms, reference, scale, rows):
        how = fail(self.how)
        if how == "lazily":
            return (fail("leaves") for _ in range(3))
        if how == "nan":
            rows[:] = np.nan
        return {"none": None, "short": [0.0]}.get(how, [0.0, 0.0, 0.0])


def made_by(how):
    return lambda model, frames: Task(fail(how) if how == "leaves" else how)


class Estimator:
    is_truth = False

    def __init__(self, how):
        self.how = how

    def estimate(self, measurement):
        q, how = measurement.q.copy(), fail(self.how)
        return {"none": None, "nan": RobotState(np.nan * q, q)}.get(how, RobotState(q[:5], measurement.v))


class Plant:
    def __init__(self, how):
        self.how = how

    def reset(self, q, v=None, torque=None):
        self.q, self.v = q, np.zeros(len(q) - 1)

    def measure(self):
        q = {"short": self.q[:9], "nan": np.nan * self.q}.get(fail(self.how), self.q)
        return None if self.how == "none" else Measurement.of_state(0.0, q, self.v)

    def act(self, command, period):
        pass


class Seat:
    parameters = {}

    def __init__(self, walk, how):
        self.posture, self.how = np.array(walk.robot.nominal_joint_positions), how

    def reset(self, q):
        pass

    def step(self, readings, command=None):
        torque = {"short": self.posture[:3], "nan": np.nan * self.posture}.get(fail(self.how), self.posture)
        return None if self.how == "none" else JointCommand(torque)


class Law:
    def __init__(self, parameters, how):
        self.count, self.how = parameters.horizon, how

    def plan(self, problem):
        if fail(self.how) == "none":
            return None
        jerk = np.full((3 if self.how == "short" else self.count, 2), np.nan)
        return Motion(jerk, np.zeros((2, 2)), np.zeros(2), np.zeros(2))


def law(how):
    return Profile(how, "fails", PlannerParameters(), lambda parameters, height: Law(parameters, how), moves=False)


class Planner:
    def __init__(self, how, *given):
        self.how, self.parameters = how, WalkingPlanner(*given).parameters

    def update(self, state, feet):
        return fail(self.how)


def planner(how):
    parts = PlannerParameters(), FootstepTvmpc
    return Profile(how, "fails", *parts, moves=True, planner=lambda *given: Planner(how, *given))


class Ground(TerrainKind):
    def __init__(self, how):
        self.name, self.how = how, how

    def build(self, ground):
        return fail(self.how)


def robot(how):
    return Robot(how, lambda options: fail(how))


@metric()
def leaves(run) -> float:
    "Leaves."
    return fail("leaves")
"""

KINDS = {
    "task": ("surefoot.tasks", "wbc.tasks=[{}]"),
    "estimator": ("surefoot.estimators", "sensing.source={}"),
    "plant": ("surefoot.plants", "plant.name={}"),
    "controller": ("surefoot.controllers", "controller.name={}"),
    "profile": ("surefoot.profiles", "planner.profile={}"),
    "terrain": ("surefoot.terrains", "terrain.kind={}"),
    "robot": ("surefoot.robots", "robot={}"),
    "metric": ("surefoot.metrics", "criteria.{}={{max: 1}}"),
}
"""Group of the entry points of each kind of part, and the setting that asks for a name."""

MADE = {
    "task": "lambda model, frames: Task('{}')",
    "estimator": "lambda walk: Estimator('{}')",
    "plant": "lambda walk: Plant('{}')",
    "controller": "lambda walk: Seat(walk, '{}')",
    "law": "law('{}')",
    "planner": "planner('{}')",
    "terrain": "Ground('{}')",
    "robot": "robot('{}')",
    "metric": "{}",
}

SHORT = ("duration=0.04", "criteria={fell: false}")
POINT = (*SHORT, "fidelity=pendulum")


@pytest.fixture
def hop(site):
    """Bring a part that fails in a way; gives its package and the setting that asks for it."""
    made = site("hop")

    def bring(part, how):
        kind = "profile" if part in ("law", "planner") else part
        group, setting = KINDS[kind]
        made.write("broken_hop.py", f"{PARTS}\n\nPART = {MADE[part].format(how)}\n")
        made.register(group, **{how: "broken_hop:PART"})
        return made, setting.format(how), f"{kind} '{how}' of package hop: "

    return bring


def run(at_hand, tmp_path, made, *settings):
    words = [word for setting in settings for word in ("--set", setting)]
    return at_hand("run", "walk", *words, "--json", "--out", str(tmp_path / "runs"), sites=[made])


RAISED = {
    "leaves": "SystemExit: 0, ",
    "root": "Root: of all, ",
    "mute": "Mute, ",
    "deep": "RecursionError: maximum recursion depth exceeded",
    "lazily": "SystemExit: 0, ",
    "none": "",
    "short": "gave ",
    "nan": "gave ",
}
"""Messages for each way to fail."""


@pytest.mark.unit
@pytest.mark.parametrize(
    ("part", "how", "keys"),
    [
        *(("law", how, POINT) for how in ("leaves", "root", "mute", "deep", "none", "short", "nan")),
        *(("planner", how, POINT) for how in ("leaves", "none")),
        *(("task", how, SHORT) for how in ("leaves", "lazily", "short", "nan")),
        *(("estimator", how, SHORT) for how in ("leaves", "short", "nan")),
        *(
            (part, how, (*SHORT, "sensing.source=truth"))
            for part in ("plant", "controller")
            for how in ("leaves", "root", "mute", "deep", "none", "short", "nan")
        ),
    ],
)
def test_in_a_run_it_is_the_reason_with_its_authors_line(hop, at_hand, tmp_path, part, how, keys):
    made, setting, who = hop(part, how)
    answer = run(at_hand, tmp_path, made, *keys, setting)
    assert answer.code == 1, answer.err
    assert "Traceback" not in answer.err
    found = json.loads(answer.out)
    assert found["verdict"] == "fail"
    assert f": {who}{RAISED[how]}" in found["reasons"][0]
    end = read(found["log"]).metadata["end"]
    assert end["kind"] == "fault"
    assert f"{made.folder / 'broken_hop.py'}:" in end["reason"]
    assert "broken_hop.py" in end["traceback"] or how in ("none", "short", "nan")
    inspected = at_hand("inspect", found["log"], "--json", sites=[made])
    assert (inspected.code, json.loads(inspected.out)["reasons"]) == (1, found["reasons"])


@pytest.mark.unit
def test_as_it_is_made_too(hop, at_hand, tmp_path):
    made, setting, who = hop("task", "leaves")
    made.write("broken_hop.py", f"{PARTS}\n\nPART = made_by('leaves')\n")
    answer = run(at_hand, tmp_path, made, *SHORT, setting)
    assert answer.code == 1, answer.err
    assert json.loads(answer.out)["reasons"][0].startswith(f"the run ended at 0.000000 s: {who}SystemExit: 0, ")


@pytest.mark.unit
@pytest.mark.parametrize("part", ["terrain", "robot"])
@pytest.mark.parametrize("how", ["leaves", "root", "mute", "none"])
def test_before_a_run_it_is_one_sentence_at_its_key(hop, at_hand, tmp_path, part, how):
    made, setting, who = hop(part, how)
    answer = run(at_hand, tmp_path, made, *POINT, setting)
    assert (answer.code, answer.out) == (2, "")
    (sentence,) = answer.err.splitlines()
    place = f"--set {setting.partition('=')[0]}"
    assert sentence.startswith(f"{place}: {who}{'gave' if how == 'none' else RAISED[how]}")
    assert "broken_hop.py:" in sentence
    assert sentence.endswith("; mend or remove it")


@pytest.mark.unit
def test_a_metric_that_leaves_takes_no_verdict_with_it(hop, at_hand, tmp_path):
    made, setting, who = hop("metric", "leaves")
    plain = run(at_hand, tmp_path, made, *POINT)
    assert plain.code == 0, plain.err
    found = json.loads(plain.out)
    assert any(said.startswith(f"{who}SystemExit: 0, {made.folder / 'broken_hop.py'}:") for said in found["notes"])
    log = found["log"]
    assert at_hand("inspect", log, sites=[made]).code == 0
    compared = at_hand("compare", log, log, "--exit-code", sites=[made])
    assert (compared.code, "same" in compared.out) == (0, True), compared.out
    asked = run(at_hand, tmp_path, made, *POINT, setting)
    assert asked.code == 1, asked.err
    assert json.loads(asked.out)["reasons"] == ["leaves is not available, so its bound cannot be checked"]


@pytest.mark.unit
def test_what_leaves_where_nobody_stands_guard_is_a_defect(at_hand, monkeypatch):
    """The exit code is the command line's own, wherever a SystemExit comes from."""
    from surefoot.scenarios.cli import listing

    namespace = {"__name__": "broken_hop"}
    exec("import sys\ndef leave():\n    sys.exit(0)\n", namespace)
    monkeypatch.setattr(listing, "lines", namespace["leave"])
    answer = at_hand("list")
    assert answer.code == 70
    assert "SystemExit: 0" in answer.err


@pytest.mark.physics
@pytest.mark.parametrize(
    ("part", "how", "codes", "status"),
    [
        pytest.param("law", "leaves", (1, 0), "failed", marks=pytest.mark.long),
        ("metric", "leaves", (1, 0), "failed"),
        pytest.param("terrain", "leaves", (2, 1), "", marks=pytest.mark.long),
        ("law", "dies", (2, 1), "could not run"),
    ],
)
def test_neither_check_nor_sweep_takes_its_exit_code(hop, tmp_path, part, how, codes, status):
    """A sweep ends with 0 where all its runs have a result; that of these is that they fail."""
    made, setting, _ = hop(part, how)
    (tmp_path / "hopping.yaml").write_text("fidelity: pendulum\nduration: 0.1\ncriteria: {fell: false}\n")
    (tmp_path / "hops.yaml").write_text("scenario: hopping.yaml\nseeds: 1\n")
    checked = made.run("check", "hopping.yaml", "--jobs", "1", "--set", setting)
    assert checked.returncode == codes[0], checked.stdout + checked.stderr
    assert status in checked.stdout
    swept = made.run("sweep", "hops.yaml", "--json", "--jobs", "1", "--out", "swept", "--set", setting)
    assert swept.returncode == codes[1], swept.stdout + swept.stderr
    assert '"pass": 1' not in swept.stdout
