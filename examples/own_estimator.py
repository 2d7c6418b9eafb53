"""A state estimator of one's own: joints by encoders, and a base whose height is 2 mm wrong."""

import surefoot
from surefoot.sim import Measurement
from surefoot.wbc import RobotState


class LowBase:
    """Believes that the base is 2 mm lower than it is."""

    is_truth = False

    def __init__(self, walk: surefoot.Walk) -> None:  # by entry point: surefoot.estimators, for sensing.source
        self.error = 0.002

    def estimate(self, measurement: Measurement) -> RobotState:
        """Give controller and planner their state."""
        q, v = measurement.q.copy(), measurement.v.copy()
        q[7:], v[6:] = measurement.joint_position, measurement.joint_velocity
        q[2] -= self.error
        return RobotState(q, v)


if __name__ == "__main__":
    scenario = surefoot.load("diagonal-walk", {"gait.steps": 2})
    result = surefoot.run(scenario, parts=surefoot.Parts(estimator=LowBase))
    print(result, f"estimation error {1e3 * result.verdict['estimation_error_rms']:.2f} mm")
