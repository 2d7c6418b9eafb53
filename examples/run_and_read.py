"""Load a scenario of the catalogue, change three keys, run it, and read arrays and verdict."""

import numpy as np

import surefoot

scenario = surefoot.load("walk", {"gait.steps": 6, "gait.step_length": 0.4, "terrain.friction": 0.6})
result = surefoot.run(scenario, seed=3, out="runs")
print(result.verdict)
print("CoP of the stance foot, 99th percentile:", result.verdict.metrics["cop_ratio_p99"])

log = surefoot.read(result.log)
time, com = log["/truth"].time, log["/truth"].field("com")  # (n,) s, (n, 3) m
zmp, reference = log["/contact"].field("zmp"), log["/reference"].field("zmp_reference")
error = np.linalg.norm(zmp[:, :2] - reference, axis=1)
print(f"{time[-1]:.2f} s, CoM from x = {com[0, 0]:.3f} m to {com[-1, 0]:.3f} m")
print(f"ZMP error: {1e3 * np.sqrt(np.nanmean(error**2)):.2f} mm RMS, {1e3 * np.nanmax(error):.1f} mm at most")
