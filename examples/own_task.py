"""A whole-body task of one's own: the head looks to the left while the robot walks."""

import numpy as np
import pinocchio as pin

import surefoot
from surefoot.wbc import BodyFrames, RobotTerms, WbcReference
from surefoot.wbc.tasks import angular_acceleration

LOCAL = pin.ReferenceFrame.LOCAL


class LookAside:
    """Orientation of the head: half a radian to the left of the heading."""

    name, size, weight = "look aside", 3, 1.0

    def __init__(self, model: pin.Model, frames: BodyFrames) -> None:  # by entry point: surefoot.tasks
        self.head = model.getFrameId("head")

    def write(self, terms: RobotTerms, reference: WbcReference, scale: np.ndarray, rows: np.ndarray) -> list[float]:
        """Write J of the head's angular acceleration in its frame; return what that shall be."""
        model, data = terms.model, terms.data
        placement = pin.updateFramePlacement(model, data, self.head)
        rows[:, : model.nv] = scale * pin.getFrameJacobian(model, data, self.head, LOCAL)[3:]
        wanted = pin.utils.rotate("z", reference.heading + 0.5)
        spin = pin.getFrameVelocity(model, data, self.head, LOCAL).angular
        drift = pin.getFrameAcceleration(model, data, self.head, LOCAL).angular  # of zero generalised acceleration
        turn = angular_acceleration((100.0, 20.0), placement.rotation, spin, wanted, (0.0, 0.0, 0.0))
        return [float(a) for a in turn - drift]


if __name__ == "__main__":
    with surefoot.Simulation(surefoot.load("walk", {"gait.steps": 3}), tasks=[LookAside]) as sim:
        while not sim.done:
            tick = sim.step()
    neck = 7 + sim.walk.robot.joint_names.index("neck_yaw")
    if tick.state is not None:
        print("fell" if sim.fell else "walked", f"with the neck turned by {tick.state.q[neck]:.2f} rad")
