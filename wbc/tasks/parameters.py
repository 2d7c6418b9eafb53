"""Weights and gains of the tasks."""

from dataclasses import dataclass

from surefoot.wbc.tunable import check, number


@dataclass(frozen=True, slots=True)
class TaskWeights:
    """Cost of a squared residual of each task.

    The measured set of docs/whole-body.md: softer trunk, swing and height tasks than those that first walked, since
    near-straight swing legs shook the CoM.

    Raises:
        ParameterError: a weight is negative or not finite, or one is zero that keeps H positive definite.
    """

    com_horizontal: float = number(10.0, "s^4/m^2", "horizontal CoM acceleration")
    com_vertical: float = number(2.5, "s^4/m^2", "vertical CoM acceleration")
    com_vertical_catching: float = number(
        100.0,
        "s^4/m^2",
        "the same while a step is adapted to catch the body, whose swing would else lift it off its legs",
    )
    angular_momentum: float = number(2.0, "s^4/m^4", "rate of angular momentum over mass")
    angular_momentum_catching: float = number(
        0.2, "s^4/m^4", "the same while a step is adapted to catch the body, whose arms and trunk then bear its swing"
    )
    orientation: float = number(1.0, "s^4", "angular acceleration of pelvis and torso")
    upright_catching: float = number(
        0.1,
        "s^4",
        "the same about the horizontal axes while a step is adapted to catch the body, which its hips may then lean",
    )
    turning_catching: float = number(
        0.01,
        "s^4",
        "the same about the vertical while a step is adapted to catch the body, which its stance foot then need not "
        "keep from turning",
    )
    swing: float = number(
        10.0, "s^4/m^2", "linear acceleration of the swing foot, and angular one times the robot's size"
    )
    upper_posture: float = number(0.5, "s^4", "joint acceleration of waist, arms and head")
    upper_posture_catching: float = number(0.05, "s^4", "the same while a step is adapted to catch the body")
    leg_posture: float = number(1e-5, "s^4", "joint acceleration of the legs")
    acceleration: float = number(
        1e-5, "s^4/m^2", "any generalised acceleration, an angular one times the robot's size", positive=True
    )
    force: float = number(1e-6, "1/N^2", "sole force less its planned share of the weight", positive=True)
    moment: float = number(1e-4, "1/(N·m)^2", "moment at a sole's centre", positive=True)

    def __post_init__(self) -> None:
        check(self, "wbc", "weights")


@dataclass(frozen=True, slots=True)
class TaskGains:
    """Feedback of each task: stiffness [1/s^2] and damping [1/s].

    Of pelvis and torso, 40 / s^2 let a trunk fold at the waist whose mass sits 0.2 m higher than the model says, more
    than 250 / s^2 pays for 1 degree of start noise with a ZMP at the edge. Those of the swing foot are critically
    damped.

    Raises:
        ParameterError: a gain is negative or not finite.
    """

    orientation: tuple[float, float] = number((250.0, 32.0), "1/s^2, 1/s", "stiffness and damping of pelvis and torso")
    swing: tuple[float, float] = number(
        (400.0, 40.0), "1/s^2, 1/s", "stiffness and damping of the swing foot, position and rotation"
    )
    posture: tuple[float, float] = number(
        (20.0, 9.0), "1/s^2, 1/s", "stiffness and damping of the joints towards the posture"
    )
    angular_momentum: float = number(3.0, "1/s", "decay of the angular momentum")

    def __post_init__(self) -> None:
        check(self, "wbc", "gains")
