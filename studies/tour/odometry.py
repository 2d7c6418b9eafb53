"""The estimator of the row ``contract``: legs' odometry of what the benchmark hands over."""

from surefoot.models.pinocchio import pinocchio_model
from surefoot.scenarios.setup.walk import Walk
from surefoot.sim.measurement import Measurement
from surefoot.wbc.estimation.estimate import Estimate
from surefoot.wbc.estimation.leg_odometry import LegOdometry


class ContractOdometry:
    """Estimates place and velocity of the base by attitude, turning, joints and their torques.

    Args:
        walk: whose robot it is.

    Attributes:
        is_truth: never.
    """

    is_truth = False

    def __init__(self, walk: Walk) -> None:
        robot = walk.robot
        half_size = 0.5 * robot.sole_length, 0.5 * robot.sole_width
        self._legs = LegOdometry(pinocchio_model(robot), robot.sole_sites, half_size, 1.0 / walk.rates.control)

    def estimate(self, measurement: Measurement) -> Estimate:
        """The estimate; of the measurement, place and speed of the base are not looked at."""
        return self._legs.sense(measurement.time, measurement.q, measurement.v, measurement.joint_torque)
