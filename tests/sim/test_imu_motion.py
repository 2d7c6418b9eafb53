"""The motion of an IMU beyond joints that follow others, against that of the engine."""

import mujoco
import numpy as np
import pytest

from surefoot.models.convert import Coordinates
from surefoot.models.types import ImuPlace
from surefoot.sim.imu_motion import ImuChain, rotation_of

pytestmark = pytest.mark.unit

ROBOT = """
<mujoco>
  <worldbody>
    <body name="base"><freejoint/><geom size="0.1"/>
      <body name="hip" pos="0.05 0.1 -0.1"><joint name="follower" axis="0.6 0.8 0" pos="0 0 {beside}"/>
        <geom size="0.1"/>
        <body name="knee" pos="0 0 -0.3"><joint name="leader" axis="1 0 0"/><geom size="0.1"/></body>
      </body>
    </body>
  </worldbody>
  <equality><joint joint1="follower" joint2="leader" polycoef="0.3 -0.7 0 0 0"/></equality>
  <actuator><motor joint="leader"/></actuator>
</mujoco>
"""


@pytest.mark.parametrize("beside", [0.0, 0.04])
@pytest.mark.parametrize("body", ["hip", "knee"])
def test_it_moves_with_joints_that_follow_others_at_an_angle(body, beside):
    model, rng = mujoco.MjModel.from_xml_string(ROBOT.format(beside=beside)), np.random.default_rng(5)
    data, coordinates, turned = mujoco.MjData(model), Coordinates(model), rng.normal(size=4)
    place = ImuPlace(body, (0.02, -0.03, 0.05), tuple((turned / np.linalg.norm(turned)).tolist()))
    chain = ImuChain(model, model.body("base").id, place, np.zeros(3), np.zeros(3))
    for _ in range(5):
        q, v, speed = rng.normal(size=8), rng.normal(size=7), np.zeros(6)
        q[3:7] /= np.linalg.norm(q[3:7])
        coordinates.to_mujoco(q, v, data.qpos, data.qvel)
        mujoco.mj_forward(model, data)
        found, R = chain.motion(q, v), data.body(body).xmat.reshape(3, 3)
        mujoco.mj_objectVelocity(model, data, mujoco.mjtObj.mjOBJ_XBODY, model.body(body).id, speed, 0)
        np.testing.assert_allclose(found.rotation, R @ rotation_of(np.array(place.quaternion)), atol=1e-12)
        np.testing.assert_allclose(np.asarray(found.rotation) @ found.angular_velocity, speed[:3], atol=1e-11)
        lever = R @ np.array(place.position)
        np.testing.assert_allclose(found.velocity, speed[3:] + np.cross(speed[:3], lever), atol=1e-11)
