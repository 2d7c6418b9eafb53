"""What the scenario checks need of a robot, with the robot descriptions imported only when asked."""

from dataclasses import dataclass
from typing import TYPE_CHECKING, Protocol

from surefoot.scenarios.file.schema import Scenario

if TYPE_CHECKING:
    from surefoot.models.types import RobotDescription


@dataclass(frozen=True, slots=True)
class RobotFacts:
    """Numbers of a robot that bound a scenario.

    Attributes:
        bodies: names of its bodies.
        leg_length: hip centre to sole with the knee straight [m].
        hip_width: distance between the hip centres [m].
        com_above_hip: CoM height over the hip centres, standing straight [m].
        foot_length: of the soles [m].
        foot_width: of the soles [m].
        shank_spacing: lateral distance of the soles at which upright shanks keep apart [m].
    """

    bodies: tuple[str, ...]
    leg_length: float
    hip_width: float
    com_above_hip: float
    foot_length: float
    foot_width: float
    shank_spacing: float


class Robots(Protocol):
    """The robots that scenarios may name."""

    def names(self) -> tuple[str, ...]:
        """Names of all robots."""
        ...

    def facts(self, scenario: Scenario) -> RobotFacts:
        """Facts of a scenario's robot with its options.

        Raises:
            ValueError: the robot cannot have these options.
        """
        ...


class RegisteredRobots:
    """The robots of ``models``."""

    def names(self) -> tuple[str, ...]:
        """Names of all robots."""
        from surefoot.models.registry import robot_names

        return robot_names()

    def facts(self, scenario: Scenario) -> RobotFacts:
        """Facts of a scenario's robot; which body carries the payload does not matter to them."""
        options = scenario.robot_options.model_copy(update={"payload_body": None})
        description = describe(scenario.model_copy(update={"robot_options": options}))
        return RobotFacts(
            bodies=description.bodies,
            leg_length=description.leg_length,
            hip_width=description.hip_width,
            com_above_hip=_straight_com_height(description) - description.leg_length,
            foot_length=description.sole_length,
            foot_width=description.sole_width,
            shank_spacing=description.shank_spacing,
        )


def describe(scenario: Scenario) -> "RobotDescription":
    """Describe a scenario's robot with its options."""
    from surefoot.models.registry import describe as describe_robot
    from surefoot.models.types import RobotOptions

    return describe_robot(scenario.robot, RobotOptions(**scenario.robot_options.model_dump()))


def _straight_com_height(description: "RobotDescription") -> float:
    """CoM height above the soles with every joint at zero, which is straight legs [m]."""
    import mujoco

    model = mujoco.MjModel.from_xml_string(description.mjcf)
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    mujoco.mj_comPos(model, data)
    return float(data.subtree_com[0, 2] - data.site(description.sole_sites[0]).xpos[2])
