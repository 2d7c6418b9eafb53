"""Knees of the legs that carry are nearly straight."""

from dataclasses import dataclass

import numpy as np

from surefoot.wbc.body.model import RobotTerms
from surefoot.wbc.parameters import StraightKnees
from surefoot.wbc.reference import WbcReference
from surefoot.wbc.tasks.law import TaskLaw
from surefoot.wbc.types import Array


@dataclass(frozen=True, slots=True)
class Knees:
    """The knees of a robot, (left, right).

    Attributes:
        joints: indices among the actuated joints.
        straight: their angles with straight legs [rad].
        turn: angle of each knee's joint for a flexion of the leg, negative where it bends the other way [-].
    """

    joints: tuple[int, int]
    straight: tuple[float, float]
    turn: tuple[float, float]


class StanceKnees(TaskLaw):
    """Acceleration of the knees of the legs that carry, towards a small flexion: K (q_d - q) - D q'.

    Where the CoM's height is held softly, this says how high the body is carried (Griffin et al., Straight-leg walking
    through underconstrained whole-body control, ICRA 2018). A row counts by the planned share of the weight on its
    foot: the rear leg of a double support is to fold, and the front one takes over without a jump. While a step catches
    the body neither counts: it needs its legs elsewhere.
    """

    name, size = "knees", 2

    def __init__(self, parameters: StraightKnees, knees: Knees) -> None:
        """Set up the task of a robot's knees."""
        self.weight, self.catching_weight = parameters.weight, 0.0
        self._k, self._d = parameters.gains
        flexion = parameters.flexion
        angles = [angle + flexion * turn for angle, turn in zip(knees.straight, knees.turn, strict=True)]
        self._columns = np.array([6 + joint for joint in knees.joints], dtype=np.int64)
        self._angles = np.array(angles)

    def put(self, terms: RobotTerms, reference: WbcReference, scale: Array, rows: Array, target: Array) -> None:
        """See ``TaskLaw.put``."""
        for k in range(2):
            column = self._columns[k]
            share = reference.load_share[1] if k else reference.load_share[0]
            rows[k, column] = scale[k] * share
            wanted = self._k * (self._angles[k] - terms._q[column + 1]) - self._d * terms._v[column]
            target[k] = share * wanted
