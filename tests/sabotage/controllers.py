"""Whole-body controllers that a careless change could have made, each worse in a way a user would call bad."""

from collections import deque
from dataclasses import replace

import numpy as np
import pinocchio as pin

from surefoot.wbc.controller import WholeBodyController

LATE_TICKS = 2
"""4 ms at 500 Hz."""


def soft_swing(*, parameters, **rest):
    """A quarter of the gain of the swing foot's task."""
    stiffness, damping = parameters.gains.swing
    gains = replace(parameters.gains, swing=(0.25 * stiffness, 0.25 * damping))
    return WholeBodyController(parameters=replace(parameters, gains=gains), **rest)


class HeavyLeg(WholeBodyController):
    """The left leg's weight is not compensated."""

    def __init__(self, *, model, leg_joints, **rest):
        super().__init__(model=model, leg_joints=leg_joints, **rest)
        left = np.array([name.startswith("left") for name in model.names[2:]])
        self._leg, self._data = left & leg_joints, model.createData()

    def interpret(self, terms, solution):
        answer = super().interpret(terms, solution)
        gravity = pin.computeGeneralizedGravity(terms.model, self._data, terms.q)
        answer.torque[self._leg] -= gravity[6:][self._leg]
        return answer


class LongStep(WholeBodyController):
    """The left foot swings to a place a centimetre ahead of where it shall."""

    def update(self, reference, sensing, fail_solvers=False):
        if reference.swing_foot == 0:
            reference = replace(reference, swing_position=reference.swing_position + np.array([0.01, 0.0, 0.0]))
        return super().update(reference, sensing, fail_solvers)


class LateTorque(WholeBodyController):
    """Torques arrive 4 ms late."""

    def __init__(self, **given):
        super().__init__(**given)
        self._late = deque(maxlen=LATE_TICKS + 1)

    def update(self, reference, sensing, fail_solvers=False):
        report = super().update(reference, sensing, fail_solvers)
        self._late.append(report.torque.copy())
        return replace(report, torque=self._late[0])


def wide_cone(*, sole, **rest):
    """Believes in three times the friction that there is."""
    return WholeBodyController(sole=replace(sole, friction=3.0 * sole.friction), **rest)


def loose_balance(*, parameters, **rest):
    """A DCM gain of 2.4 in place of 3."""
    balance = replace(parameters.balance, dcm=0.8 * parameters.balance.dcm)
    return WholeBodyController(parameters=replace(parameters, balance=balance), **rest)


def loose_trunk(*, parameters, **rest):
    """Half the gains of the orientation of pelvis and torso."""
    stiffness, damping = parameters.gains.orientation
    gains = replace(parameters.gains, orientation=(0.5 * stiffness, 0.5 * damping))
    return WholeBodyController(parameters=replace(parameters, gains=gains), **rest)


SABOTAGES = {
    "task gain quartered": soft_swing,
    "gravity compensation of a leg dropped": HeavyLeg,
    "foot target off by 1 cm": LongStep,
    "torque 4 ms late": LateTorque,
    "friction cone too wide": wide_cone,
}
"""Sabotages that walks show."""

CONTROLLERS = {**SABOTAGES, "DCM gain 2.4 in place of 3": loose_balance, "orientation gains halved": loose_trunk}
"""With those that no walk shows, since it is planned anew from where the robot is 50 times a second."""
