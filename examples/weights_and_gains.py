"""Weights and gains of the whole-body controller, from Python as from a file: what a softer swing foot costs."""

import surefoot

for stiffness in (400.0, 200.0):
    keys = {"wbc.gains.swing": [stiffness, 2.0 * stiffness**0.5], "wbc.weights.swing": 5.0, "gait.steps": 2}
    sim = surefoot.Simulation(surefoot.load("walk", keys))
    strain = 0.0
    while not sim.done:
        tick = sim.step()
        if tick.report is not None:
            strain = max(strain, float(abs(tick.report.torque / sim.walk.robot.torque_limit).max()))
    outcome = "fell" if sim.fell else "walked"
    print(f"{stiffness:.0f} / s^2: {outcome}, largest torque {100 * strain:.1f} % of the limit")
    sim.close()
