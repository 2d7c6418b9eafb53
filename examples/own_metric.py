"""A metric of one's own: registered here for this process; by entry point surefoot.metrics for every command."""

import numpy as np

import surefoot
from surefoot.scenarios.judge.metric import RunView, metric
from surefoot.scenarios.judge.metrics import register


@metric(unit="m", shown=(1e3, "mm"), reads={"/truth": ("com",)})
def com_sway(run: RunView) -> float:
    """Standard deviation of the CoM's lateral position [m]."""
    return float(np.std(run.field("/truth", "com")[:, 1]))


if __name__ == "__main__":
    register(com_sway)
    keys = {"fidelity": "pendulum", "criteria.com_sway": {"max": 0.04}}
    for width in (0.2, 0.3):
        result = surefoot.run(surefoot.load("walk", {**keys, "gait.step_width": width}), out=f"runs/{width}")
        print(f"feet {width} m apart:", result)
        print(f"    the CoM sways by {1e3 * result.verdict['com_sway']:.0f} mm")
