"""A whole-body task of one's own: the head looks to the left while the robot walks."""

import numpy as np
import pinocchio as pin

import surefoot
from surefoot.wbc import BodyFrames, RobotTerms, WbcReference
from surefoot.wbc.tasks import Task, angular_acceleration

Array = np.ndarray


class LookAside:
    """Orientation of the head: half a radian to the left of the heading."""

    name, size, weight = "look aside", 3, 1.0

    def __init__(self, model: pin.Model, frames: BodyFrames) -> None:
        self.head = model.getFrameId("head")

    def write(self, terms: RobotTerms, reference: WbcReference, scale: Array, rows: Array) -> list[float]:
        """Write J of the angular acceleration in the head's frame; return what it shall be."""
        model, data, local = terms.model, terms.data, pin.ReferenceFrame.LOCAL
        placement = pin.updateFramePlacement(model, data, self.head)
        rows[:, : model.nv] = scale * pin.getFrameJacobian(model, data, self.head, local)[3:]
        wanted = pin.utils.rotate("z", reference.heading + 0.5)
        spin = pin.getFrameVelocity(model, data, self.head, local).angular
        drift = pin.getFrameAcceleration(model, data, self.head, local).angular  # with zero joint accelerations
        target = angular_acceleration((100.0, 20.0), placement.rotation, spin, wanted, (0.0, 0.0, 0.0))
        return [float(a) for a in target - drift]


def make(model: pin.Model, frames: BodyFrames) -> Task:  # by entry point: surefoot.tasks
    """Make the task for a robot."""
    return LookAside(model, frames)


if __name__ == "__main__":
    with surefoot.Simulation(surefoot.load("walk", {"gait.steps": 4}), tasks=[make]) as sim:
        while not sim.done:
            tick = sim.step()
    names = sim.walk.robot.joint_names
    assert tick.state is not None
    print("fell" if sim.fell else "walked", f"neck yaw {tick.state.q[7 + names.index('neck_yaw')]:.2f} rad")
