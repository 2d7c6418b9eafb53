"""A loop of one's own around Surefoot's controller: MuJoCo's model of a robot, stepped and measured by hand."""

import mujoco
import numpy as np

import surefoot
from surefoot.models.convert import mujoco_to_pinocchio
from surefoot.sim import World

scenario = surefoot.load("walk", {"sensing.source": "truth", "gait.steps": 2})
controller = surefoot.Controller("humanoid100", scenario)
robot, rates = controller.walk.robot, scenario.rates
model = mujoco.MjModel.from_xml_string(World(robot, controller.walk.ground.terrain, rates.physics).mjcf())
data = mujoco.MjData(model)
data.qpos[:3], data.qpos[7:] = controller.posture[:3], controller.posture[7:]
data.qpos[2] -= 1e-4  # let the soles sink in as far as the ground gives way
q, v = np.zeros(model.nq), np.zeros(model.nv)
controller.reset(controller.posture)

while data.time < 6.0:
    mujoco_to_pinocchio(data.qpos, data.qvel, q, v)
    seen = surefoot.Measurement.of_state(data.time, q, v, data.qfrc_actuator[6:])  # no force is felt
    command = controller.step(seen)
    data.ctrl[:] = command.torque
    mujoco.mj_step(model, data, rates.physics // rates.control)

print(f"walked {data.qpos[0]:.2f} m, the pelvis is {data.qpos[2]:.2f} m high")
