"""A first robot file: feet by shape, comments that are keys, refusals that name what is missing."""

from pathlib import Path

import pytest
import yaml

from surefoot.models.robot_file.draft import draft
from surefoot.models.robot_file.schema import RobotFile, read
from surefoot.models.types import RobotError

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


def test_a_model_that_cannot_be_used_as_it_is_gives_a_file_and_says_why(tmp_path: Path) -> None:
    made = draft(f"{DATA}/icub_description/robots/icub_reduced.urdf", tmp_path)
    assert "inertia: repair" in made.refusal
    assert yaml.safe_load(made.text)["name"] == "icub_reduced"


def test_an_arm_has_no_feet_to_stand_on(tmp_path: Path) -> None:
    assert "leg" in draft(f"{DATA}/panda_description/urdf/panda.urdf", tmp_path).refusal


def test_no_model_is_one_sentence(tmp_path: Path) -> None:
    with pytest.raises(RobotError, match=r"nothing\.urdf"):
        draft("nothing.urdf", tmp_path)
