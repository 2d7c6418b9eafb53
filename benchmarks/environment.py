"""Cost of an environment over the `Simulation` that it is made of: CPU time of the same episode, in turns.

python -m benchmarks.environment
"""

import time
from collections.abc import Callable

import numpy as np

import surefoot
import surefoot.gym

SETTINGS = {"duration": 3.0, "gait.steps": 0, "criteria": {"fell": False}, "robot": "g1"}
ROUNDS = 7


def stepped() -> Callable[[], float]:
    """CPU time of an episode in the environment, one action a step [s]."""
    env = surefoot.gym.WalkEnv("stand", settings=SETTINGS, verdict=False)
    action = np.zeros(env.action_space.shape, np.float32)

    def episode() -> float:
        env.reset(seed=0)
        begin, over = time.thread_time(), False
        while not over:
            _, _, terminated, truncated, _ = env.step(action)
            over = terminated or truncated
        return time.thread_time() - begin

    return episode


def simulated() -> Callable[[], float]:
    """CPU time of the same episode in a `Simulation`, its controller held where the environment's is [s]."""
    from surefoot.studies.training.environment import first_contract
    from surefoot.studies.training.learner import NAME

    keys = {**SETTINGS, "controller.name": NAME, "controller.options": {"contract": first_contract("g1")}}
    scenario = surefoot.load("stand", keys)

    def episode() -> float:
        with surefoot.Simulation(scenario) as sim:
            begin = time.thread_time()
            while not sim.done:
                sim.advance()
            return time.thread_time() - begin

    return episode


def main() -> None:
    """Print both, and the ratio of their least times."""
    environment = stepped()  # which has the process know the controller of both
    kinds = {"Simulation": simulated(), "environment": environment}
    least = dict.fromkeys(kinds, np.inf)
    for _ in range(ROUNDS):
        for name, episode in kinds.items():
            least[name] = min(least[name], episode())
    for name, seconds in least.items():
        print(f"{name}: {seconds:.3f} s for {SETTINGS['duration']} s")
    print(f"environment over Simulation: {least['environment'] / least['Simulation'] - 1.0:+.1%}")


if __name__ == "__main__":
    main()
