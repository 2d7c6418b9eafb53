"""The planner alone, fed with a state of one's own: a mass that does exactly what the plan says, but is pushed once."""

import numpy as np

from surefoot.planner import CentroidalState, FeetState, Foot, GaitParameters, PlanSampler, WalkingPlanner

feet = FeetState(np.array([[0.0, 0.1, 0.0], [0.0, -0.1, 0.0]]), np.zeros(2), (True, True))
gait = GaitParameters(steps=4, step_length=0.2, single_support=0.7, double_support=0.3)
planner = WalkingPlanner(gait, feet, foot_length=0.2, foot_width=0.1)
period = planner.parameters.sample_time

com, velocity, time = np.array([0.0, 0.0, 1.0]), np.zeros(3), 0.0
while time < 6.0:
    plan = planner.update(CentroidalState(time, com, velocity), feet)
    if round(time / 0.02) % 50 == 0:
        steps = [f"{Foot(s.foot).name.lower()} {s.position[:2].round(3)}" for s in plan.footsteps]
        print(f"{time:.2f} s, {plan.phase.kind.name.lower()}: ZMP {plan.zmp[0].round(3)}, next footsteps {steps}")
    reference = PlanSampler(plan).sample(time + period)
    time, com, velocity = time + period, reference.com, reference.com_velocity
    if abs(time - 2.5) < 1e-9:
        velocity = velocity + np.array([0.05, 0.0, 0.0])  # what 5 N s do to 100 kg
    if plan.swing is not None:  # feet that follow the plan
        position = feet.position.copy()
        position[plan.swing.foot] = plan.swing.evaluate(min(time, plan.swing.touchdown_time))[0, :3]
        feet = FeetState(position, feet.yaw, reference.contacts)
    else:
        feet = FeetState(feet.position, feet.yaw, reference.contacts)
