"""The influence of the ZMP on the DCM: the weight of each sample of a window, and what all of them keep bounded.

The DCM obeys ξ' = (λ/ω) (ξ - p). Seen from now the ZMP of sample k counts by the weight w_k of `planner.model.dcm`.
Σ w_k p_k is the DCM that stays bounded.
"""

import numpy as np

from surefoot.maths import algebra
from surefoot.planner.model import dcm as law
from surefoot.planner.parameters import PlannerParameters
from surefoot.planner.references.window import Window
from surefoot.planner.types import Array

COLUMNS = 5
"""Columns of the bounded motion: DCM on both axes [m], gain of the next step [-], room of the CoP on both axes [m]."""


class Outlook:
    """A window of references, as recovery looks at it.

    Args:
        parameters: of the planner.
    """

    def __init__(self, parameters: PlannerParameters) -> None:
        self.sample_time = parameters.sample_time
        self._foot_margin = parameters.foot_margin
        self._resize(parameters.horizon + parameters.preview + 1)
        self.bounded = np.zeros((3, COLUMNS))
        self._ahead, self._next = np.zeros(COLUMNS), np.zeros(COLUMNS)

    def _resize(self, count: int) -> None:
        self.count = count
        self.decay = np.zeros(count)

    def see(self, window: Window) -> None:
        """Look at a window."""
        driving = window.driving
        self.stiffness, self.omega = window.stiffness, window.omega
        self.point, self.gain, self.half_size = driving.point, driving.gain, driving.half_size
        self.middle = driving.middle
        if len(self.stiffness) != self.count:
            self._resize(len(self.stiffness))
        law.fade(self.stiffness, self.omega, self.sample_time, self.decay)

    def margin(self, dcm: Array, window: Window) -> float:
        """Margin of the DCM in what the CoP captures with the steps as planned: Σ w (p + m ± a) of all in sight.

        Args:
            dcm: now in the plan frame, shape (2,) [m].
            window: references.
        """
        self.see(window)
        margin = algebra.INFINITY
        for axis in range(2):
            point, half = 0.0, 0.0
            for k in range(self.count):
                weight = law.weight(self.decay, k)
                point += weight * (self.point[k, axis] + self.middle[k, axis])
                half += weight * self.half_size[k, axis]
            margin = min(margin, half / self._foot_margin - abs(dcm[axis] - point))
        return float(margin)

    def nominal(self, window: Window) -> Array:
        """The DCM now that a window's ZMP keeps bounded, shape (2,) [m]."""
        self.see(window)
        found = np.zeros(2)
        for axis in range(2):
            point = 0.0
            for k in range(self.count):
                point += law.weight(self.decay, k) * self.point[k, axis]
            found[axis] = point
        return found

    def look(self, lift: int, lands: int) -> None:
        """Set `bounded` to the bounded motion now, as the foot leaves the ground and as it lands.

        It is the backward recursion ξ_k d_k = Σ_{j ≥ k} (d_j - d_{j+1}) (p_j + p_{j+1}) / 2, which ends on the last
        ZMP. The room of the CoP is what it has in double support beyond its room on the other foot alone.

        Args:
            lift: sample at which the foot leaves the ground.
            lands: sample at which it lands, after that.
        """
        last = self.count - 1
        for column in range(COLUMNS):
            self._ahead[column] = self._next[column] = 0.0
        for k in range(last, -1, -1):
            share = law.share(self.decay, k)
            for column in range(COLUMNS):
                value = self._driving(k, column, lift)
                self._ahead[column] += share * (value + self._next[column])
                self._next[column] = value
            if k == lands:
                self._note(2, k)
            if k == lift:
                self._note(1, k)
            if k == 0:
                self._note(0, k)

    def _driving(self, k: int, column: int, lift: int) -> float:
        if column < 2:
            return float(self.point[k, column])
        if column == 2:
            return float(self.gain[k, 0])
        return float(self.half_size[k, column - 3] - self.half_size[lift, column - 3]) if k < lift else 0.0

    def _note(self, row: int, k: int) -> None:
        for column in range(COLUMNS):
            self.bounded[row, column] = self._ahead[column] / self.decay[k]
