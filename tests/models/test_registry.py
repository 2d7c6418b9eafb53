import pytest

from surefoot.models.registry import UnknownRobotError, describe, robot_names
from surefoot.models.types import RobotError, RobotOptions

pytestmark = pytest.mark.unit


def test_every_name_describes_a_robot() -> None:
    for name in robot_names():
        assert describe(name, RobotOptions()).name == name


def test_unknown_robot_gets_the_nearest_name() -> None:
    with pytest.raises(UnknownRobotError, match="there is no robot 'humanoid10': did you mean 'humanoid100'"):
        describe("humanoid10", RobotOptions())


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (RobotOptions(foot_length=0.0), "foot_length is 0.0 m, it must lie within"),
        (RobotOptions(foot_width=float("nan")), "foot_width is nan m, it must lie within"),
        (RobotOptions(payload_mass=-1.0), "payload_mass is -1.0 kg, it must be"),
        (RobotOptions(payload_mass=float("inf")), "payload_mass is inf kg, it must be"),
        (RobotOptions(payload_mass=1.0, payload_body="torsoo"), "did you mean 'torso'"),
        (RobotOptions(payload_body="xyz"), "choose from pelvis"),
    ],
)
def test_impossible_options_are_refused_in_one_sentence(options: RobotOptions, message: str) -> None:
    with pytest.raises(RobotError, match=message):
        describe("humanoid100", options)
