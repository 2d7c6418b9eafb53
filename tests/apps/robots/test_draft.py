"""A first robot file: feet by shape, comments that are keys, refusals that name what is missing."""

import sys
from pathlib import Path

import numpy as np
import pinocchio as pin
import pytest
import typer
import yaml

from surefoot.apps.robots.command import new
from surefoot.apps.robots.draft import _feet, draft
from surefoot.models import RobotOptions, describe
from surefoot.models.robot_file.schema import RobotFile, read
from surefoot.models.types import RobotError

sys.path.insert(0, str(Path(__file__).parents[2] / "models" / "robot_file"))
import biped

pytestmark = pytest.mark.unit

DATA = "package://example-robot-data/robots"
G1 = f"{DATA}/g1_description/urdf/g1_29dof_rev_1_0.urdf"


@pytest.mark.parametrize(
    ("model", "left", "right"),
    [
        (G1, "left_ankle_roll_link", "right_ankle_roll_link"),
        (f"{DATA}/icub_description/robots/icub_reduced.urdf", "l_ankle_2", "r_ankle_2"),  # its base looks backward
    ],
    ids=["g1", "icub"],
)
def test_feet_are_found_by_shape_and_left_is_left(tmp_path: Path, model: str, left: str, right: str) -> None:
    made = yaml.safe_load(draft(model, tmp_path).text)
    assert made["feet"] == {"left": left, "right": right}
    assert made["model"] == model


def test_what_is_made_is_a_robot_file_and_so_is_each_comment(tmp_path: Path) -> None:
    made = draft(G1, tmp_path)
    assert made.refusal == ""
    file = tmp_path / "mine.yaml"
    file.write_text(made.text)
    assert read(file).name == "g1_29dof_rev_1_0"
    others = [line[2:] for line in made.text.split("unless it is given here:\n")[1].splitlines()]
    keys = {key for line in others for key in yaml.safe_load(line)}
    assert keys == set(RobotFile.model_fields) - {"name", "model", "feet"}
    file.write_text(made.text + "".join(f"{line}\n" for line in others if "LINK" not in line))
    assert read(file).torso == "torso_link"


def test_a_model_with_an_inertia_of_no_body_gives_a_file_that_repairs_it_and_says_why(tmp_path: Path) -> None:
    made = draft(f"{DATA}/icub_description/robots/icub_reduced.urdf", tmp_path)
    assert made.refusal == ""
    assert yaml.safe_load(made.text)["inertia"] == "repair"
    assert "# link 'r_hip_1' of" in made.text


@pytest.mark.parametrize(
    ("head", "name"),
    [
        ('<robot name="my biped">', "my-biped"),
        ("<robot version='1.0' name='biped_v2'>", "biped_v2"),
        ('<robot name="">', "mine"),
    ],
)
def test_the_name_is_that_of_the_model(tmp_path: Path, head: str, name: str) -> None:
    (tmp_path / "mine.urdf").write_text(biped.Biped(changes={'<robot name="biped">': head}).urdf())
    assert yaml.safe_load(draft("mine.urdf", tmp_path).text)["name"] == name


def test_the_sole_that_is_told_is_the_one_that_was_derived(tmp_path: Path) -> None:
    """Its centre too: a file that says it describes the same robot."""
    (tmp_path / "mine.urdf").write_text(biped.Biped().urdf())
    text = draft("mine.urdf", tmp_path).text
    told = next(line[2:] for line in text.splitlines() if line.startswith("# sole:"))
    assert yaml.safe_load(told)["sole"]["centre"] == pytest.approx([biped.AHEAD, 0.0, -biped.ANKLE])
    robots = []
    for number, lines in enumerate((text, f"{text}{told}\n")):
        (tmp_path / f"{number}.yaml").write_text(lines)
        robots.append(describe(str(tmp_path / f"{number}.yaml"), RobotOptions()))
    assert robots[0].com_height == pytest.approx(robots[1].com_height, abs=1e-3)


def test_soles_that_are_wider_than_long_are_remarked(tmp_path: Path) -> None:
    x, y, z = biped.FOOT
    wide = biped.Biped(changes={f'<box size="{x} {y} {z}"/>': f'<box size="{y} {x} {z}"/>'}).urdf()
    (tmp_path / "mine.urdf").write_text(wide)
    assert "# Note: soles are wider (0.180 m) than long (0.080 m)" in draft("mine.urdf", tmp_path).text


@pytest.mark.parametrize(("feet", "code"), [(True, 0), (False, 1)])
def test_the_exit_code_says_whether_the_file_can_be_used(
    tmp_path: Path, monkeypatch, capsys, feet: bool, code: int
) -> None:
    (tmp_path / "mine.urdf").write_text(biped.Biped(feet=feet).urdf())
    monkeypatch.chdir(tmp_path)
    try:
        new("mine.urdf")
    except typer.Exit as end:
        assert end.exit_code == code
    else:
        assert code == 0
    assert yaml.safe_load(capsys.readouterr().out)["feet"] == {"left": "left_foot", "right": "right_foot"}


def test_an_arm_has_no_feet_to_stand_on(tmp_path: Path) -> None:
    assert "leg" in draft(f"{DATA}/panda_description/urdf/panda.urdf", tmp_path).refusal


def test_no_model_is_one_sentence(tmp_path: Path) -> None:
    with pytest.raises(RobotError, match=r"nothing\.urdf"):
        draft("nothing.urdf", tmp_path)


@pytest.mark.parametrize(
    "name", ["null", "12", "no", "1_000", "2001-01-01", "a: b", "a, b", "a #b", "'q", "*s", "%", "\u00e9"]
)
def test_names_that_yaml_would_read_as_something_else_are_quoted(tmp_path: Path, name: str) -> None:
    text = biped.Biped().urdf().replace('<robot name="biped"', f'<robot name="{name}"')
    (tmp_path / f"{name}.urdf").write_text(text.replace('"left_foot"', f'"{name}"'))
    made = draft(f"{name}.urdf", tmp_path)
    assert made.refusal == ""
    (tmp_path / "mine.yaml").write_text(made.text)
    file = read(tmp_path / "mine.yaml")
    assert (file.model, file.soles().left) == (f"{name}.urdf", name)
    assert describe(str(tmp_path / "mine.yaml"), RobotOptions()).name == file.name


def chain(model: pin.Model, name: str, place, joints: int) -> None:
    """Add a chain of hinges that ends at a place."""
    parent = 1
    for number in range(joints):
        at = pin.SE3(np.eye(3), np.array(place, dtype=float)) if number == 0 else pin.SE3.Identity()
        parent = model.addJoint(parent, pin.JointModelRX(), at, f"{name}{number}")
    model.addFrame(pin.Frame(name, parent, 0, pin.SE3.Identity(), pin.FrameType.BODY))


def test_feet_are_ends_of_chains_alike_whatever_is_up() -> None:
    """A head and a hand may be beside each other, and lower along z, in a model whose y is up."""
    model = pin.Model()
    model.addJoint(0, pin.JointModelFreeFlyer(), pin.SE3.Identity(), "base")
    chain(model, "left_toes", (0.4, -0.9, 0.2), 7)
    chain(model, "right_toes", (-0.4, -0.9, 0.2), 7)
    chain(model, "head", (0.0, 0.6, 0.0), 18)
    chain(model, "hand", (0.8, 0.4, 0.0), 19)
    assert set(_feet(model)) == {"left_toes", "right_toes"}
    one_sided = pin.Model()
    one_sided.addJoint(0, pin.JointModelFreeFlyer(), pin.SE3.Identity(), "base")
    chain(one_sided, "left", (0.0, 0.1, -0.8), 6)
    chain(one_sided, "right", (0.0, -0.1, -0.8), 7)
    assert _feet(one_sided) == ("left", "right")
