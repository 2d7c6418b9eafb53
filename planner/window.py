"""What is known of horizon and preview before the motion is planned."""

from dataclasses import dataclass, replace

import numpy as np

from planner.com_height import HeightPreview, HeightShape, preview_height
from planner.dcm import natural_frequency
from planner.footsteps import FootstepPlan
from planner.leg_chain import LegChain
from planner.leg_inertia import Feet, SwingShape, nominal_feet, softening, zmp_offset
from planner.nominal import nominal_motion
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

    def window(self, sample: int, support: Support, footsteps: FootstepPlan, position: Array) -> Window:
        """The window that begins at a sample.

        Args:
            sample: the first.
            support: what carries the robot now, with the plan frame.
            footsteps: footholds in the world frame.
            position: CoM now in the plan frame, shape (2,) [m].
        """
        reference = zmp_reference(self.schedule, support.table, sample, self.count)
        height = preview_height(self.height, sample, self.count, support.heights, reference.height)
        stiffness = softening(self.leg) * height.stiffness
        omega = natural_frequency(stiffness, self.schedule.sample_time)
        if self.leg.chain is None:
            offset = np.zeros_like(reference.point)
        else:
            samples = np.maximum(np.arange(sample - 1, sample + self.count), 0)
            feet = nominal_feet(self.swing, footsteps, (support.rotation, support.origin), samples)
            offset = self._offset(self.leg.chain, feet, position, reference.point, height, stiffness)
        driving = replace(reference, point=reference.point - offset)
        return Window(sample, reference, driving, offset, height, stiffness, omega)

    def _offset(
        self,
        chain: LegChain,
        feet: Feet,
        position: Array,
        reference: Array,
        height: HeightPreview,
        stiffness: Array,
    ) -> Array:
        """ZMP offset for a CoM on the nominal motion, which itself depends on it: two passes leave a millimetre."""
        offset = np.zeros_like(reference)
        for _ in range(2):
            motion = nominal_motion(position, reference - offset, stiffness, self.schedule.sample_time)
            offset = zmp_offset(chain, feet, motion, height, stiffness)
        return offset
