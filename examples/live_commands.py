"""A walk that is commanded while it goes on, is pushed on the way, and is walked again from its log."""

from pathlib import Path
from tempfile import TemporaryDirectory

import surefoot

scenario = surefoot.load("commanded", {"commands": [], "duration": 12.0, "gait.step_length": 0.35})
with TemporaryDirectory() as folder:
    log = Path(folder) / "commanded.mcap"
    with surefoot.Simulation(scenario, log=log) as sim:
        while not sim.done:
            if sim.time == 0.5:
                sim.command(v_x=0.9, yaw_rate=0.3)  # m/s and rad/s
            if sim.time == 2.0:
                print(f"asked for 0.9 m/s, walks at {sim.orders.followed}")
            if sim.time == 2.6:
                sim.command(single_support=0.43)  # quicker from now on, in the middle of a step
            if sim.time == 3.0:
                sim.push([0.0, 150.0, 0.0], duration=0.1)  # N in the world frame
            if sim.time == 3.4:
                sim.go_to(1.5, 0.4, yaw=0.0)
            tick = sim.step()
    print(tick, sim.end.kind)
    again = surefoot.run(log, out=folder)
    same = surefoot.read(log)["/truth"].field("com") == surefoot.read(again.log)["/truth"].field("com")
    print(f"{1e3 * again.verdict['place_error']:.1f} mm from where it was to go; walked again the same: {same.all()}")
