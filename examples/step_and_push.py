"""Step a simulation one control tick at a time, look into it, push the robot, and stop when it stands again."""

import numpy as np

import surefoot

scenario = surefoot.load("walk", {"gait.steps": 5})
with surefoot.Simulation(scenario, seed=3) as sim:  # log="push.mcap" writes a log
    pushed = False
    while not sim.done:
        tick = sim.step()
        if not pushed and tick.plan.phase.step == 2:
            sim.push((80.0, 0.0, 0.0), duration=0.1)  # N in the world frame, s; on the torso, from the next tick on
            pushed = True
            print("pushed at", tick)
        if tick.report is not None and round(500 * tick.time) % 250 == 0:
            forces = tick.report.wrench[:, 2]  # planned normal forces of the left and the right sole [N]
            print(f"{tick.time:.1f} s: forces {forces.round()} N, next foot at {tick.reference.swing[:2].round(2)} m")
        still = bool(np.linalg.norm(tick.com_velocity) < 0.02)
        if tick.plan.phase.step == 5 and still and tick.time > 1.0:
            break
    print("fell" if sim.fell else "stands", "at", sim.step())
