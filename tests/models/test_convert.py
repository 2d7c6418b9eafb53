import mujoco
import numpy as np
import pinocchio as pin
import pytest

from surefoot.models import convert
from surefoot.models.consistency import EnginePair
from surefoot.models.registry import describe
from surefoot.models.types import RobotOptions

pytestmark = pytest.mark.unit


@pytest.fixture(scope="module")
def pair() -> EnginePair:
    return EnginePair(describe("humanoid100", RobotOptions()))


def _to_mujoco(q: np.ndarray, v: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    qpos, qvel = np.empty_like(q), np.empty_like(v)
    convert.pinocchio_to_mujoco(q, v, qpos, qvel)
    return qpos, qvel


def test_state_round_trip(pair: EnginePair) -> None:
    rng = np.random.default_rng(3)
    for _ in range(20):
        q, v = pair.random_state(rng)
        back_q, back_v = np.empty_like(q), np.empty_like(v)
        convert.mujoco_to_pinocchio(*_to_mujoco(q, v), back_q, back_v)
        np.testing.assert_allclose(back_q, q, atol=1e-14)
        np.testing.assert_allclose(back_v, v, atol=1e-13)


def test_acceleration_round_trip(pair: EnginePair) -> None:
    rng = np.random.default_rng(4)
    q, v = pair.random_state(rng)
    a = rng.normal(size=v.size)
    back, (qpos, qvel) = np.empty_like(a), _to_mujoco(q, v)
    qacc = convert.velocity_map(qpos, v.size) @ a
    qacc[:3] += convert.velocity_map(qpos, v.size)[:3, :3] @ np.cross(v[3:6], v[:3])
    convert.mujoco_acceleration_to_pinocchio(qpos, qvel, qacc, back)
    np.testing.assert_allclose(back, a, atol=1e-13)


def test_velocity_map_is_the_conversion(pair: EnginePair) -> None:
    q, v = pair.random_state(np.random.default_rng(5))
    qpos, qvel = _to_mujoco(q, v)
    np.testing.assert_allclose(convert.velocity_map(qpos, v.size) @ v, qvel, atol=1e-14)


def test_both_engines_integrate_the_velocity_to_the_same_place(pair: EnginePair) -> None:
    q, v = pair.random_state(np.random.default_rng(6))
    step = 1e-6
    qpos, qvel = _to_mujoco(q, v)
    mujoco.mj_integratePos(pair.mj_model, qpos, qvel, step)
    expected, _ = _to_mujoco(pin.integrate(pair.pin_model, q, step * v), v)
    np.testing.assert_allclose(qpos, expected, atol=1e-11)  # the linear part differs to second order in the step


def test_free_fall_has_the_same_acceleration_in_both_engines(pair: EnginePair) -> None:
    """Forward dynamics of both engines, through the acceleration conversion: M and h and frames at once."""
    q, v = pair.random_state(np.random.default_rng(8))
    qpos, qvel = _to_mujoco(q, v)
    data = mujoco.MjData(pair.mj_model)
    data.qpos[:], data.qvel[:] = qpos, qvel
    mujoco.mj_forward(pair.mj_model, data)
    a = np.empty_like(v)
    convert.mujoco_acceleration_to_pinocchio(qpos, qvel, data.qacc_smooth, a)
    pin_data = pair.pin_model.createData()
    M = pin.crba(pair.pin_model, pin_data, q)
    h = pin.nonLinearEffects(pair.pin_model, pin_data, q, v)
    np.testing.assert_allclose(M @ a + h, 0.0, atol=1e-9)


FOLLOWING = """
<mujoco>
  <worldbody>
    <body name="base"><freejoint/><geom size="0.1"/>
      <body><joint name="follower" axis="0 1 0"/><geom size="0.1"/>
        <body pos="0 0 0.3"><joint name="leader" axis="1 0 0"/><geom size="0.1"/>
          <body pos="0 0 0.3"><joint name="other" axis="0 0 1"/><geom size="0.1"/></body>
        </body>
      </body>
    </body>
  </worldbody>
  <equality><joint joint1="follower" joint2="leader" polycoef="0.3 -0.7 0 0 0"/></equality>
  <actuator><motor joint="leader"/><motor joint="other"/></actuator>
</mujoco>
"""


def test_a_joint_that_follows_another_one_is_where_the_equality_wants_it() -> None:
    """As MuJoCo has it, also where it is apart from there."""
    model = mujoco.MjModel.from_xml_string(FOLLOWING)
    data, of, rng = mujoco.MjData(model), convert.Coordinates(model), np.random.default_rng(7)
    for leader, other in rng.normal(size=(5, 2)):
        of.bend(np.array([leader, other]), data.qpos)
        np.testing.assert_allclose(data.qpos[7:], [0.3 - 0.7 * leader, leader, other])
        np.testing.assert_allclose(of.apart(data.qpos), 0.0, atol=1e-12)
        data.qpos[7:] += rng.normal(size=3)
        mujoco.mj_forward(model, data)
        np.testing.assert_allclose(of.apart(data.qpos), data.efc_pos[:1], atol=1e-12)
    assert of.law_of(1) == (0, -0.7, 0.3)
    assert of.law_of(2) == (0, 1.0, 0.0)
