from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np
import pinocchio as pin
import pytest

from surefoot.models.pinocchio import pinocchio_model
from surefoot.models.registry import describe
from surefoot.models.types import RobotOptions
from surefoot.wbc.body.ik import PostureIk, PostureTarget
from surefoot.wbc.body.limits import JointLimits
from surefoot.wbc.body.model import BodyFrames
from surefoot.wbc.contact.cone import Sole
from surefoot.wbc.controller import WholeBodyController
from surefoot.wbc.parameters import WbcParameters
from surefoot.wbc.qp.data import QpData
from surefoot.wbc.reference import WbcReference
from surefoot.wbc.tasks import Task
from surefoot.wbc.tasks.knees import Knees
from surefoot.wbc.types import FootSensing, RobotState

PERIOD = 0.002
HALF_SOLE = 0.0375
WIDTH = 0.2
HEIGHT = 1.0


@dataclass(frozen=True)
class Robot:
    """humanoid100 as the controller knows it, with a standing posture."""

    model: pin.Model
    frames: BodyFrames
    limits: JointLimits
    nominal: np.ndarray
    standing: np.ndarray
    leg_joints: np.ndarray

    @property
    def nv(self) -> int:
        return self.model.nv

    def ik(self) -> PostureIk:
        return PostureIk(self.model, self.frames, self.limits, self.nominal)

    @property
    def shoulders(self) -> tuple[int, int]:
        """Left and right shoulder pitch among the actuated joints."""
        left, right = (self.model.getJointId(f"{side}_shoulder_pitch") - 2 for side in ("left", "right"))
        return left, right

    def controller(
        self,
        parameters: WbcParameters | None = None,
        limbs: pin.GeometryModel | None = None,
        tasks: Sequence[Task] = (),
        arm_back: tuple[float, float] = (1.0, 1.0),
        driven: np.ndarray | None = None,
        kind: type[WholeBodyController] = WholeBodyController,
        knees: Knees | None = None,
    ) -> WholeBodyController:
        return kind(
            self.model, self.frames, Sole(HALF_SOLE, HALF_SOLE, 0.8), self.limits, self.standing[7:], self.leg_joints,
            PERIOD, parameters or WbcParameters(), limbs, self.shoulders, tasks,
            arm_back=arm_back, driven=driven, knees=knees,
        )  # fmt: skip

    def moved(self, rng: np.random.Generator, offset: float = 0.05, speed: float = 0.3) -> RobotState:
        """A state near the standing one."""
        q = pin.integrate(self.model, self.standing, rng.uniform(-offset, offset, self.nv))
        return RobotState(q, rng.uniform(-speed, speed, self.nv))


def stance(com: tuple[float, float, float] = (0.0, 0.0, HEIGHT)) -> PostureTarget:
    feet = np.array([[0.0, WIDTH / 2, 0.0], [0.0, -WIDTH / 2, 0.0]])
    return PostureTarget(feet, np.zeros(2), np.array(com), 0.0)


@pytest.fixture(scope="session")
def robot() -> Robot:
    description = describe("humanoid100", RobotOptions())
    model = pinocchio_model(description)
    d = description
    frames = BodyFrames(d.sole_sites, d.torso_body)
    limits = JointLimits(d.torque_limit, d.velocity_limit, d.position_lower, d.position_upper)
    q = pin.neutral(model)
    q[2] = d.leg_length
    q[7:] = d.nominal_joint_positions
    result = PostureIk(model, frames, limits, d.nominal_joint_positions).solve(stance(), q)
    assert result.reached
    legs = np.array([any(part in name for part in ("hip", "knee", "ankle")) for name in d.joint_names])
    return Robot(model, frames, limits, d.nominal_joint_positions, result.q, legs)


@pytest.fixture
def rng() -> np.random.Generator:
    return np.random.default_rng(7)


def standing_reference(**changes: object) -> WbcReference:
    zero = np.zeros(3)
    reference = WbcReference(
        com=np.array([0, 0, HEIGHT]), com_velocity=zero, com_acceleration=zero, zmp=np.zeros(2),
        zmp_offset=np.zeros(2), omega=np.sqrt(9.81), stiffness=9.81, heading=0.0, heading_rate=0.0,
        planned_contact=(True, True), load_share=(0.5, 0.5),
        time_to_switch=np.inf, lifting_foot=-1, swing_foot=-1, swing_progress=0.0, swing_position=zero,
        swing_velocity=zero, swing_acceleration=zero, swing_rotation=np.eye(3),
        swing_angular_velocity=zero, swing_angular_acceleration=zero, ground_normal=np.tile([0.0, 0.0, 1.0], (2, 1)),
    )  # fmt: skip
    return replace(reference, **changes)


def swing_reference(**changes: object) -> WbcReference:
    """Left foot stands, right foot swings."""
    swing = {
        "zmp": np.array([0.0, WIDTH / 2]), "com": np.array([0.0, 0.08, HEIGHT]), "planned_contact": (True, False),
        "load_share": (1.0, 0.0), "swing_foot": 1, "swing_progress": 0.3, "time_to_switch": 0.5,
        "swing_position": np.array([0.1, -WIDTH / 2, 0.05]), "swing_velocity": np.array([0.4, 0.0, 0.1]),
        "swing_acceleration": np.array([0.5, -0.2, -1.0]), "swing_rotation": pin.utils.rotate("z", 0.1),
        "swing_angular_velocity": np.array([0.0, 0.0, 0.2]), "swing_angular_acceleration": np.array([0.0, 0.0, -0.3]),
    }  # fmt: skip
    return standing_reference(**(swing | changes))


@pytest.fixture
def references() -> tuple[Callable[..., WbcReference], Callable[..., WbcReference]]:
    """Makers of references: both feet stand; the right foot swings."""
    return standing_reference, swing_reference


@pytest.fixture
def loaded() -> FootSensing:
    return FootSensing((490.0, 490.0))


@pytest.fixture(params=["standing", "swing"])
def reference(request: pytest.FixtureRequest) -> WbcReference:
    return standing_reference() if request.param == "standing" else swing_reference()


@pytest.fixture(scope="session")
def problems(robot: Robot) -> list[QpData]:
    """Whole-body QPs of still and shaken states, with near targets and with targets that the limits forbid."""
    rng, found = np.random.default_rng(3), []
    far = standing_reference(com=np.array([0.3, 0.2, 1.3])), swing_reference(swing_position=np.array([2.0, -0.5, 0.6]))
    for reference in (standing_reference(), swing_reference(), *far):
        controller = robot.controller()
        for speed in (0.0, 0.1, 0.3):
            controller.observe(robot.moved(rng, 0.003, speed))
            controller.update(reference, FootSensing((490.0, 490.0)))
            found.append(controller.qp.copy())
    return found
