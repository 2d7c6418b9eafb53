"""A plant of one's own in place of the simulated world: MuJoCo with another integrator and twice as many steps."""

import mujoco
import numpy as np

import surefoot
from surefoot.models.convert import mujoco_to_pinocchio, pinocchio_to_mujoco
from surefoot.sim import World


class Finer:
    """Knows the state of its robot and nothing of the forces on its feet."""

    def __init__(self, walk: surefoot.Walk, refined: int = 2) -> None:  # by entry point: surefoot.plants, plant.name
        self.rate = refined * walk.rates.physics
        mjcf = World(walk.true_robot, walk.ground.true_terrain, self.rate, size=walk.size).mjcf()
        self.model = mujoco.MjModel.from_xml_string(mjcf)
        self.model.opt.integrator = mujoco.mjtIntegrator.mjINT_IMPLICITFAST
        self.data = mujoco.MjData(self.model)

    def reset(self, q: np.ndarray, v: np.ndarray | None = None, torque: np.ndarray | None = None) -> None:
        """Stand at the start of a walk."""
        pinocchio_to_mujoco(q, np.zeros(self.model.nv) if v is None else v, self.data.qpos, self.data.qvel)

    def measure(self) -> surefoot.Measurement:
        """Measure the state now."""
        q, v = np.zeros(self.model.nq), np.zeros(self.model.nv)
        mujoco_to_pinocchio(self.data.qpos, self.data.qvel, q, v)
        return surefoot.Measurement.of_state(self.data.time, q, v)

    def act(self, command: surefoot.JointCommand, period: float) -> None:
        """Do what is commanded for so long [s]."""
        self.data.ctrl[:] = command.torque
        mujoco.mj_step(self.model, self.data, round(period * self.rate))


if __name__ == "__main__":
    keys = {"sensing.source": "truth", "gait.steps": 2, "criteria": {"speed_mean": {"max": 1.0}}}
    scenario = surefoot.load("walk", keys)  # without a method read it has no sensors
    print(surefoot.run(scenario, parts=surefoot.Parts(plant=Finer)))
