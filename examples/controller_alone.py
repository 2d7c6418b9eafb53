"""The whole-body controller alone, on a reference of one's own: the robot stands and begins to shift its weight."""

from dataclasses import replace

import numpy as np

import surefoot
from surefoot.wbc import FootSensing, WbcReference

sim = surefoot.Simulation(surefoot.load("stand"))  # a robot in its start posture, to have a state
tick = sim.step()
controller, state = sim.controller, tick.state
assert state is not None
terms = controller.observe(state)
com, foot = terms.com.copy(), terms.sole_position.copy()
still = WbcReference(
    com=com, com_velocity=np.zeros(3), com_acceleration=np.zeros(3), zmp=com[:2], zmp_offset=np.zeros(2),
    omega=np.sqrt(9.81 / com[2]), stiffness=9.81 / com[2], heading=0.0, heading_rate=0.0,
    planned_contact=(True, True), load_share=(0.5, 0.5), time_to_switch=np.inf, lifting_foot=-1,
    swing_foot=-1, swing_progress=0.0, swing_position=np.zeros(3), swing_velocity=np.zeros(3),
    swing_acceleration=np.zeros(3), swing_rotation=np.eye(3), swing_angular_velocity=np.zeros(3),
    swing_angular_acceleration=np.zeros(3), ground_normal=np.tile([0.0, 0.0, 1.0], (2, 1)),
)  # fmt: skip
for shift in (0.0, 0.01, 0.02):  # m to the left
    target = com + np.array([0.0, shift, 0.0])
    report = controller.update(replace(still, com=target, zmp=target[:2]), FootSensing((490.5, 490.5)))
    left, right = report.wrench[:, 2]
    print(f"CoM to the left by {1e3 * shift:2.0f} mm: status {report.status.name}, forces {left:.0f} and {right:.0f} N")

contacts = controller.schedule.update(still, FootSensing((490.5, 490.5)))
qp = controller.build(terms, still, contacts).copy()  # the QP itself, to be looked at, or solved by something else
print(f"QP: {qp.g.size} variables, {qp.A.shape[0]} rows, condition of H {np.linalg.cond(qp.H):.1e}")
