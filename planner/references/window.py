"""What is known of horizon and preview before the motion is planned."""

from dataclasses import dataclass, replace

import numpy as np

from surefoot.planner.model.dcm import natural_frequency, nominal_motion
from surefoot.planner.model.leg_chain import LegChain
from surefoot.planner.parameters import LegInertia
from surefoot.planner.references.com_height import HeightPreview, HeightShape, preview_height
from surefoot.planner.references.leg_offset import SwingShape, nominal_feet, softening, zmp_offset
from surefoot.planner.references.zmp_reference import Support, ZmpReference, zmp_reference
from surefoot.planner.types import Array
from surefoot.planner.walk.clock import Schedule
from surefoot.planner.walk.footsteps import FootstepPlan

_TICKS = 5
"""Ticks for which an offset of the legs serves; making it costs more than the rest of a plan."""


@dataclass(frozen=True, slots=True)
class OffsetTable:
    """What the swing leg adds to the ZMP over a window and some samples more, and what it was made from.

    Attributes:
        start: first sample.
        support: the support then; its plan frame is that of the values.
        footsteps: the footholds then.
        values: shape (m, 2) [m].
    """

    start: int
    support: Support
    footsteps: FootstepPlan
    values: Array


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
        table: where the offset comes from; None without legs.
    """

    start: int
    reference: ZmpReference
    driving: ZmpReference
    offset: Array
    height: HeightPreview
    stiffness: Array
    omega: Array
    table: OffsetTable | None


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

    def window(
        self,
        sample: int,
        support: Support,
        footsteps: FootstepPlan,
        position: Array,
        table: OffsetTable | None = None,
    ) -> Window:
        """The window that begins at a sample.

        Args:
            sample: the first.
            support: what carries the robot now, with the plan frame.
            footsteps: footholds in the world frame.
            position: CoM now in the plan frame, shape (2,) [m].
            table: offsets of the tick before, used again where they still hold.
        """
        reference = zmp_reference(self.schedule, support.table, sample, self.count)
        height = preview_height(self.height, sample, self.count, support.heights, reference.height)
        stiffness = softening(self.leg) * height.stiffness
        omega = natural_frequency(stiffness, self.schedule.sample_time)
        if self.leg.chain is None:
            table, offset = None, np.zeros_like(reference.point)
        else:
            if table is None or not self._holds(table, sample, support, footsteps):
                table = self._offsets(self.leg.chain, sample, support, footsteps, position)
            offset = table.values[sample - table.start :][: self.count]
        driving = replace(reference, point=reference.point - offset)
        return Window(sample, reference, driving, offset, height, stiffness, omega, table)

    def _holds(self, table: OffsetTable, sample: int, support: Support, footsteps: FootstepPlan) -> bool:
        """Whether a table still serves; not where the walk's clock rests, since a table goes on with time."""
        same = table.support is support and table.footsteps is footsteps
        return same and table.start < sample < min(table.start + _TICKS, self.schedule.last)

    def _offsets(
        self, chain: LegChain, sample: int, support: Support, footsteps: FootstepPlan, position: Array
    ) -> OffsetTable:
        """Offsets for a CoM on the nominal motion, which itself depends on them: two passes leave a millimetre."""
        count = min(self.count + _TICKS - 1, len(self.schedule.index) - sample)
        reference = zmp_reference(self.schedule, support.table, sample, count)
        height = preview_height(self.height, sample, count, support.heights, reference.height)
        stiffness = softening(self.leg) * height.stiffness
        samples = np.maximum(np.arange(sample - 1, sample + count), 0)
        feet = nominal_feet(self.swing, footsteps, (support.rotation, support.origin), samples)
        offset = np.zeros_like(reference.point)
        for _ in range(2):
            motion = nominal_motion(position, reference.point - offset, stiffness, self.schedule.sample_time)
            offset = zmp_offset(chain, feet, motion, height, stiffness)
        return OffsetTable(sample, support, footsteps, offset)
