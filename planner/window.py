"""What is known of horizon and preview before the motion is planned."""

from dataclasses import dataclass, replace

import numpy as np

from planner.com_height import HeightPreview, HeightShape, preview_height
from planner.dcm import natural_frequency
from planner.footsteps import FootstepPlan
from planner.leg_inertia import SwingShape, softening, zmp_offset
from planner.parameters import LegInertia
from planner.schedule import Schedule
from planner.support import Support
from planner.types import Array
from planner.zmp_reference import ZmpReference, zmp_reference


@dataclass(frozen=True, slots=True)
class Window:
    """References over the window of one tick, in the plan frame.

    Attributes:
        start: first sample.
        reference: ZMP reference that the footsteps define.
        driving: what of it drives the pendulum: the reference less `offset`.
        offset: what the swing leg adds to the ZMP, shape (n, 2) [m].
        height: CoM height.
        stiffness: λ of the pendulum, softened by the legs' masses, shape (n,) [1/s^2].
        omega: ω of its DCM, shape (n,) [1/s].
    """

    start: int
    reference: ZmpReference
    driving: ZmpReference
    offset: Array
    height: HeightPreview
    stiffness: Array
    omega: Array


@dataclass(frozen=True, slots=True)
class Outlook:
    """Looks ahead along a walk.

    Attributes:
        schedule: its phases.
        height: its CoM height.
        swing: its swings.
        leg: the reduced leg.
        count: samples of a window, N + M + 1.
    """

    schedule: Schedule
    height: HeightShape
    swing: SwingShape
    leg: LegInertia
    count: int

    def window(self, sample: int, support: Support, footsteps: FootstepPlan) -> Window:
        """The window that begins at a sample."""
        reference = zmp_reference(self.schedule, support.table, sample, self.count)
        height = preview_height(self.height, sample, self.count, support.heights, reference.height)
        offset = self._offset(sample, support, footsteps, reference, height)
        stiffness = softening(self.leg) * height.stiffness
        omega = natural_frequency(stiffness, self.schedule.sample_time)
        driving = replace(reference, point=reference.point - offset)
        return Window(sample, reference, driving, offset, height, stiffness, omega)

    def _offset(
        self, sample: int, support: Support, footsteps: FootstepPlan, reference: ZmpReference, height: HeightPreview
    ) -> Array:
        if self.leg.mass_ratio == 0.0:
            return np.zeros_like(reference.point)
        return zmp_offset(
            self.swing,
            footsteps,
            (support.rotation, support.origin),
            slice(sample, sample + self.count),
            np.column_stack((reference.point, reference.height)),
            height.stiffness,
            height.height[0] - reference.height,
            self.leg,
        )
