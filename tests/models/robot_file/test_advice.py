"""Proposals of a refusal are accepted when they are followed: of robot files, of models, and of walks."""

import re
import shlex
from dataclasses import replace

import biped
import numpy as np
import pytest
import yaml

from surefoot.apps.robots.draft import draft
from surefoot.apps.robots.examine import examine
from surefoot.models import RobotError, RobotOptions, describe
from surefoot.scenarios.errors import ScenarioError, SetupError
from surefoot.scenarios.run.simulation import Simulation
from surefoot.scenarios.setup.feasible import proposal_text
from surefoot.scenarios.setup.load import load

pytestmark = pytest.mark.unit

NO_ARM = r'(<link name="left_forearm">)<inertial>.*?</inertial>'
NO_MOMENT = r'(<link name="left_shank">.*?)<inertia .*?/>'
ZERO, ONE = (f'<inertia ixx="{xx}" iyy="0" izz="0" ixy="0" ixz="0" iyz="0"/>' for xx in (0, 1))


def model(**changes) -> str:
    return biped.Biped(**changes).urdf()


REFUSED = {
    "swapped feet": (model(), "feet: {left: right_foot, right: left_foot}\n"),
    "wrong forward": (model(), "forward: -x\n"),
    "misspelt torso": (model(), "torso: left_am\n"),
    "misspelt pattern": (model(), "armature: {left_elbo: 0.1}\n"),
    "misspelt lock": (model(), "lock: [left_elbo]\n"),
    "misspelt link": (model(), "keep_apart: [[left_shnk, right_shank]]\n"),
    "misspelt key": (model(), "com_hight: 0.5\n"),
    "no torque": (model(changes={'effort="80"': 'effort="0"'}), ""),
    "no sole": (model(feet=False), ""),
    "an arm without inertia": (re.sub(NO_ARM, r"\1", model()), ""),
    "a shank without moments": (re.sub(NO_MOMENT, rf"\1{ZERO}", model()), ""),
    "moments of no body": (re.sub(NO_MOMENT, rf"\1{ONE}", model()), ""),
    "posture out of range": (model(), "posture: {left_knee: -1}\n"),
    "a key of another robot": ("", "model: humanoid100\ncom_height: 0.5\n"),
}


def followed(said: str, file: dict) -> dict:
    """The file with what a sentence proposes, as its reader would write it."""
    advice, new = said.split("; ", 1)[1], dict(file)
    meant = re.search(r"did you mean '([^']+)'", advice)
    written = re.search(r"write '?(\w+: (?:\{[^}]*\}|\[[^\]]*\]|\w+))", advice)
    given = re.search(r"give (\w+): (\{[^}]*\})", advice)
    within = re.search(r"within ([-\d.]+) and ([-\d.]+)", advice)
    if meant:
        wrong = re.search(r"(?:names|pattern|key) '([^']+)'", said)[1]
        return yaml.safe_load(yaml.safe_dump(file).replace(wrong, meant[1]))
    if written:
        return new | yaml.safe_load(written[1])
    if given:
        value = (
            {"PATTERN": None} if "PATTERN" in given[2] else {"length": 0.16, "width": 0.08, "centre": [0.03, 0, -0.06]}
        )
        return new | {given[1]: {"*": 80.0} if "PATTERN" in value else value}
    if within:
        return new | {"posture": {"left_knee": float(within[2]) / 2}}
    if "leave it out" in advice:
        return {key: value for key, value in new.items() if key != "forward"}
    assert "name, model and scale alone" in advice, said
    return {key: value for key, value in new.items() if key in ("name", "model", "scale")}


@pytest.mark.parametrize("case", REFUSED)
def test_a_robot_file_that_follows_its_refusal_is_accepted(tmp_path, case) -> None:
    urdf, more = REFUSED[case]
    file = yaml.safe_load(biped.FILE) if urdf else {"name": "half"}
    file |= yaml.safe_load(more) or {}
    path = biped.write(tmp_path, urdf or model(), yaml.safe_dump(file))
    with pytest.raises(RobotError) as refusal:
        describe(str(path), RobotOptions())
    path.write_text(yaml.safe_dump(followed(str(refusal.value), file)))
    assert describe(str(path), RobotOptions()).mass > 0.0


def test_a_drafted_file_can_be_used_with_what_it_writes_itself(tmp_path) -> None:
    """An inertia that no body has is repaired, and said to be, in a file that is accepted."""
    (tmp_path / "biped.urdf").write_text(REFUSED["a shank without moments"][0])
    made = draft("biped.urdf", tmp_path)
    assert made.refusal == ""
    (tmp_path / "mine.yaml").write_text(made.text)
    assert yaml.safe_load(made.text)["inertia"] == "repair"
    assert "left_shank" in made.text
    describe(str(tmp_path / "mine.yaml"), RobotOptions())


SLOW = {"velocity_limit": {"*": 15, "*_pitch": 2.2}}
WEAK = {"torque_limit": {"*": 80, "*_knee": 13.5}}
WALKS = {
    "too slow": ("walk-level", SLOW),
    "too slow to turn": ("walk-turn", {"velocity_limit": {"*": 15, "*_yaw": 0.5}}),
    "too slow on stairs": ("stairs-up", SLOW),
    "too weak": ("walk-level", WEAK),
    "too weak for stairs": ("stairs-tall", {"torque_limit": {"*": 80, "*_knee": 34}}),
    "too high a CoM": ("walk-level", {"scenario": {"gait.com_height": 0.525}}),
    "far too high a CoM": ("walk-level", {"scenario": {"gait.com_height": 0.7}}),
    "too slow for what it is told": ("commanded", {"velocity_limit": {"*": 15, "*_yaw": 0.5}}),
}


def refusal_of(name: str, overrides: dict) -> str:
    """Reason why a scenario is refused before its run; nothing where it is accepted."""
    try:
        Simulation(load(name, overrides)).close()
    except (ScenarioError, SetupError) as error:
        return str(error)
    return ""


def proposal_in(said: str) -> dict:
    """Values by key of 'take for example --set KEY=VALUE --set KEY=VALUE', as a shell takes its words."""
    words = shlex.split(re.split(r" [(\[](?!\{)", said.split("take for example ")[1])[0])
    assert words[::2] == ["--set"] * (len(words) // 2)
    return {key: yaml.safe_load(value) for key, value in (word.split("=", 1) for word in words[1::2])}


def test_a_proposal_is_told_as_options_that_a_shell_takes() -> None:
    proposal = {"gait.step_length": 0.138, "gait.velocity": [{"time": 0.0, "yaw_rate": 0.118}], "gait.turn": 0.2}
    said = proposal_text(proposal)
    assert said.startswith("--set gait.step_length=0.138 --set 'gait.velocity=[{")
    assert proposal_in(f"slow; take for example {said} (0.5 in the file)") == proposal


def bounded(said: str, overrides: dict, name: str) -> dict:
    """Settings that follow 'KEY ...; use at most NUMBER'."""
    limit = re.search(r"(?:at most|less than) ([\d.]+)", said)[1]
    key = re.search(r"yaw_rate of|gait\.\w+", said)[0]
    if key == "yaw_rate of":
        commands = [command.model_dump(exclude_none=True) for command in load(name, overrides).commands]
        slower = [one | {"yaw_rate": min(one.get("yaw_rate", 0.0), float(limit))} for one in commands if "v_x" in one]
        return overrides | {"commands": slower}
    return overrides | {key: float(limit) - (0.001 if "less than" in said else 0.0)}


@pytest.mark.parametrize("case", WALKS)
def test_a_walk_that_follows_its_refusal_is_accepted(tmp_path, case) -> None:
    """At once; where a bound of a single key was given, what is refused next is another thing."""
    name, given = WALKS[case]
    given = dict(given)
    overrides = given.pop("scenario", {})
    path = biped.write(tmp_path, None, biped.FILE + yaml.safe_dump(given) if given else biped.FILE)
    overrides = {**overrides, "robot": str(path)}
    said = refusal_of(name, overrides)
    assert said
    while "take for example" not in said and said:
        overrides = bounded(said, overrides, name)
        before, said = said, refusal_of(name, overrides)
        assert said.split(" is out of reach")[0] != before.split(" is out of reach")[0]
    if said:
        assert "robot 'biped'" in said or "of 'biped'" in said
        assert refusal_of(name, overrides | proposal_in(said)) == ""


@pytest.mark.parametrize(
    ("case", "left_out"),
    [
        ("too slow", "speed_mean"),
        ("too slow to turn", "heading_change"),
        ("too slow on stairs", ""),
        ("too weak", "speed_mean"),
    ],
)
def test_a_proposal_says_what_it_leaves_out_of_the_criteria(tmp_path, case, left_out) -> None:
    """Criteria on the speed or the way of the walk as it was; other postures and lower steps leave none out."""
    name, given = WALKS[case]
    path = biped.write(tmp_path, None, biped.FILE + yaml.safe_dump(given))
    said = refusal_of(name, {"robot": str(path)})
    assert ("of the criteria)" in said) == bool(left_out)
    assert f"(which leaves out {left_out} of the criteria)" in said or not left_out
    assert not re.search(r"\d{10}", said)


def test_a_com_height_that_is_proposed_can_be_stood_at(tmp_path) -> None:
    robot = describe(str(biped.write(tmp_path)), RobotOptions())
    for raised in (1.03, 1.1):
        found = examine(replace(robot, com_height=raised * robot.com_height))
        said = [text for text in (*found.faults, *found.notes) if "com_height: " in text]
        for text in said:
            height = float(re.search(r"com_height: ([\d.]+) would do", text)[1])
            again = examine(replace(robot, com_height=height))
            assert (again.one_foot if "one foot" in text else again.both_feet).share <= 1.0
        assert said or raised == 1.03


def test_a_torque_that_is_proposed_is_enough(tmp_path) -> None:
    robot = describe(str(biped.write(tmp_path)), RobotOptions())
    weak = replace(robot, torque_limit=np.where(np.isin(robot.joint_names, ["left_knee"]), 1.0, robot.torque_limit))
    for _ in range(3):
        faults = [fault for fault in examine(weak).faults if "torque_limit: {" in fault]
        for joint, needed in re.findall(r"torque_limit: \{(\w+): (\d+)\}", " ".join(faults)):
            values = np.array(weak.torque_limit)
            values[weak.joint_names.index(joint)] = max(float(needed), values[weak.joint_names.index(joint)])
            weak = replace(weak, torque_limit=values)
    assert not [fault for fault in examine(weak).faults if "N m" in fault]
