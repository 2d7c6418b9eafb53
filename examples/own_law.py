"""A law of motion of one's own in the walking planner: a ZMP that goes back to its reference as a spring would."""

import numpy as np

import surefoot
from surefoot.planner import Motion, MotionProblem, PlannerParameters, Profile


class Spring:
    """Jerk that lets the ZMP error die out in 0.1 s, about the motion whose DCM the future reference keeps bounded."""

    def __init__(self, parameters: PlannerParameters, com_height: float) -> None:
        self.parameters = parameters

    def plan(self, problem: MotionProblem) -> Motion:
        """Answer one tick: the jerk of each sample of the horizon, and no footstep shifted."""
        p, state = self.parameters, problem.state.T.copy()  # x, v, a of both axes
        reference, jerks = problem.reference.point, []
        for k in range(p.horizon):
            omega, stiffness = problem.omega[k], problem.stiffness[k]
            dcm = state[0] + state[1] / omega
            decay = np.exp(-omega * p.sample_time * np.arange(len(reference) - k))[:, None]
            ahead = (decay * reference[k:]).sum(axis=0) / decay.sum()  # DCM that what comes next keeps bounded
            zmp = reference[k] + (1.0 + 4.0 / omega) * (dcm - ahead)
            jerk = (stiffness * (state[0] - zmp) - state[2]) / 0.1
            jerks.append(np.clip(jerk, -p.jerk_limit, p.jerk_limit))
            t = p.sample_time
            state += np.stack(
                (t * state[1] + t * t / 2 * state[2] + t**3 / 6 * jerk, t * state[2] + t * t / 2 * jerk, t * jerk)
            )
        return Motion(np.array(jerks), np.zeros((2, 2)), np.zeros(2), np.zeros(2))


PROFILE = Profile("spring", PlannerParameters(), Spring, moves=False)  # by entry point: surefoot.profiles

if __name__ == "__main__":
    result = surefoot.run(surefoot.load("diagonal-walk", {"criteria": {"fell": False}}), planner=PROFILE)
    print(result, result.verdict.metrics["zmp_error_rms"])
