import numpy as np
import pytest

from surefoot.models.consistency import EnginePair
from surefoot.models.pinocchio import pinocchio_model
from surefoot.models.registry import describe
from surefoot.models.types import RobotDescription, RobotError, RobotOptions

pytestmark = pytest.mark.unit

VARIANTS = {
    "paper_feet": RobotOptions(),
    "human_feet": RobotOptions(foot_length=0.22, foot_width=0.11),
    "payload": RobotOptions(payload_mass=12.0, payload_body="left_forearm"),
}


@pytest.mark.parametrize("variant", VARIANTS)
def test_engines_agree_at_random_states(variant: str) -> None:
    pair = EnginePair(describe("humanoid100", VARIANTS[variant]))
    rng = np.random.default_rng(7)
    worst = max(pair.difference(*pair.random_state(rng)).largest for _ in range(50))
    assert worst < 1e-9


def test_a_tampered_inertia_is_detected() -> None:
    pair = EnginePair(describe("humanoid100", RobotOptions()))
    pair.pin_model.inertias[3].mass += 1e-6
    difference = pair.difference(*pair.random_state(np.random.default_rng(7)))
    assert min(difference.mass_matrix, difference.bias, difference.com, difference.momentum) > 1e-9
    assert difference.jacobian < 1e-9


def test_a_tampered_armature_is_detected_in_the_mass_matrix_only() -> None:
    pair = EnginePair(describe("humanoid100", RobotOptions()))
    pair.mj_model.dof_armature[10] += 1e-6
    difference = pair.difference(*pair.random_state(np.random.default_rng(7)))
    assert difference.mass_matrix == pytest.approx(1e-6, rel=1e-3)
    assert difference.bias < 1e-9


BEYOND = {
    "stiffness": ('<joint name="left_knee"', '<joint name="left_knee" stiffness="3"'),
    "damping": ('<joint name="left_knee"', '<joint name="left_knee" damping="3"'),
    "frictionloss": ('<joint name="left_knee"', '<joint name="left_knee" frictionloss="3"'),
    "gravcomp": ('<body name="left_foot"', '<body name="left_foot" gravcomp="1"'),
    "equality": ("</mujoco>", '<equality><joint joint1="left_knee" joint2="left_hip_pitch"/></equality></mujoco>'),
    "weld": ("</mujoco>", '<equality><weld body1="left_foot" body2="left_shank"/></equality></mujoco>'),
    "tendon": (
        "</mujoco>",
        '<tendon><fixed stiffness="9"><joint joint="left_knee" coef="1"/></fixed></tendon></mujoco>',
    ),
}


@pytest.mark.parametrize("kind", BEYOND)
def test_dynamics_of_a_text_that_pinocchio_knows_nothing_of_are_a_difference(kind: str) -> None:
    description = describe("humanoid100", RobotOptions())
    assert BEYOND[kind][0] in description.mjcf
    pair = EnginePair(_with(description, mjcf=description.mjcf.replace(*BEYOND[kind])))
    difference = pair.difference(*pair.random_state(np.random.default_rng(7)))
    assert difference.others == difference.largest > 0.1
    assert max(difference.mass_matrix, difference.bias, difference.com, difference.momentum) < 1e-9


def test_pinocchio_knows_limits_armatures_and_sites() -> None:
    description = describe("humanoid100", RobotOptions())
    model = pinocchio_model(description)
    np.testing.assert_array_equal(model.upperEffortLimit[6:], description.torque_limit)
    np.testing.assert_array_equal(model.lowerEffortLimit[6:], -description.torque_limit)
    np.testing.assert_array_equal(model.upperVelocityLimit[6:], description.velocity_limit)
    np.testing.assert_array_equal(model.lowerPositionLimit[7:], description.position_lower)
    np.testing.assert_array_equal(model.upperPositionLimit[7:], description.position_upper)
    assert (model.armature[6:] > 0).all()
    assert all(model.existFrame(site) for site in (*description.sole_sites, description.imu_site))


def _with(description: RobotDescription, **changes: object) -> RobotDescription:
    fields = {name: getattr(description, name) for name in RobotDescription.__dataclass_fields__}
    return RobotDescription(**{**fields, **changes})


def test_lost_mass_is_an_error() -> None:
    description = describe("humanoid100", RobotOptions())
    lost = _with(description, mjcf=description.mjcf.replace('mass="8.0"', 'mass="7.9"', 1))
    with pytest.raises(RobotError, match=r"must be 100 kg"):
        pinocchio_model(lost)


def test_another_joint_order_is_an_error() -> None:
    description = describe("humanoid100", RobotOptions())
    with pytest.raises(RobotError, match="reads the joints"):
        pinocchio_model(_with(description, joint_names=description.joint_names[::-1]))
