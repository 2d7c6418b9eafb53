"""A law of motion of one's own in the walking planner: feedback of the DCM through the ZMP, without a QP."""

import numpy as np

import surefoot
from surefoot.planner import Motion, MotionProblem, PlannerParameters, Profile
from surefoot.planner.model.dcm import nominal_dcm


class SpringLaw:
    """ZMP p = p_ref + 3 (DCM - DCM_ref), reached through a jerk within 60 ms; footsteps are not shifted."""

    def __init__(self, parameters: PlannerParameters, com_height: float) -> None:
        self.horizon, self.period = parameters.horizon, parameters.sample_time

    def plan(self, problem: MotionProblem) -> Motion:
        """Answer one tick: the jerk of each sample of the horizon."""
        t, reference = self.period, problem.reference.point
        wanted = nominal_dcm(problem.stiffness, problem.omega, reference, t)  # what the future reference keeps bounded
        (x, v, a), jerks = problem.state.T, []
        for k in range(self.horizon):
            zmp = reference[k] + 3.0 * (x + v / problem.omega[k] - wanted[k])
            jerk = (problem.stiffness[k] * (x - zmp) - a) / 0.06
            jerks.append(jerk)
            x, v, a = x + t * v + t * t / 2 * a + t**3 / 6 * jerk, v + t * a + t * t / 2 * jerk, a + t * jerk
        return Motion(np.array(jerks), np.zeros((2, 2)), np.zeros(2), np.zeros(2))


PROFILE = Profile("spring", "DCM feedback", PlannerParameters(), SpringLaw, moves=False)  # surefoot.profiles

if __name__ == "__main__":
    scenario = surefoot.load("diagonal-walk", {"fidelity": "pendulum"})
    for name, profile in (("own", PROFILE), ("default", None)):
        result = surefoot.run(scenario, out=f"runs/{name}", planner=profile)
        print(name, result, "ZMP error", [f"{1e3 * error:.1f} mm" for error in result.verdict["zmp_error_rms"]])
