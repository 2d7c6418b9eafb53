"""What is known of horizon and preview before the motion is planned."""

from dataclasses import dataclass, replace

import numpy as np

from surefoot.planner.model.dcm import natural_frequency, nominal_motion
from surefoot.planner.model.leg_chain import LegChain
from surefoot.planner.parameters import LegInertia
from surefoot.planner.references.com_height import HeightPreview, HeightShape, preview_height
from surefoot.planner.references.leg_offset import SwingShape, nominal_feet, softening, zmp_offset
from surefoot.planner.references.zmp_reference import Support, SupportKey, ZmpReference, zmp_reference
from surefoot.planner.types import Array
from surefoot.planner.walk.clock import Schedule
from surefoot.planner.walk.footsteps import FootstepPlan

_TICKS = 5
"""Ticks for which an offset of the legs serves; making it costs more than the rest of a plan."""


@dataclass(frozen=True, slots=True)
class OffsetTable:
    """What the swing leg adds to the ZMP over a window and some samples more: planner state that outlives a tick.

    It was made for the CoM of its first tick; the offset hardly depends on it (see `planner.references.leg_offset`). So
    a plan depends on the ticks before it not only by the jerk and the swing that go on, but by at most `_TICKS` - 1 of
    them in this as well.

    Attributes:
        start: first sample.
        key: of the support then, whose plan frame is that of the values.
        values: shape (m, 2) [m].
    """

    start: int
    key: SupportKey
    values: Array

    def holds(self, sample: int, key: SupportKey, last: int) -> bool:
        """Whether it still serves: the same support and footholds, a later sample, and few of them later.

        In the final standing, where the walk's clock rests, it does not: its values go on with time.

        Args:
            sample: now.
            key: of the support now.
            last: first sample of the final standing.
        """
        return self.key == key and self.start < sample < min(self.start + _TICKS, last)


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

    def zmp(self, sample: int, support: Support, count: int | None = None) -> ZmpReference:
        """The ZMP that the footsteps define, from a sample on: the paper's ZMP planner.

        Args:
            sample: the first.
            support: what carries the robot now, with the plan frame.
            count: samples, those of a window by default.
        """
        return zmp_reference(self.schedule, support.table, sample, count or self.count)

    def com_height(self, sample: int, support: Support, reference: ZmpReference) -> HeightPreview:
        """CoM height and stiffness over the samples of a reference: the paper's vertical motion planner."""
        return preview_height(self.height, sample, len(reference.point), support.heights, reference.height)

    def window(
        self,
        sample: int,
        support: Support,
        reference: ZmpReference,
        height: HeightPreview,
        footsteps: FootstepPlan,
        position: Array,
        table: OffsetTable | None = None,
    ) -> Window:
        """The window that begins at a sample.

        Args:
            sample: the first.
            support: what carries the robot now, with the plan frame.
            reference: ZMP from there on.
            height: CoM height from there on.
            footsteps: footholds in the world frame.
            position: CoM now in the plan frame, shape (2,) [m].
            table: offsets of the tick before, used again while they hold.
        """
        stiffness = softening(self.leg) * height.stiffness
        omega = natural_frequency(stiffness, self.schedule.sample_time)
        if self.leg.chain is None:
            table, offset = None, np.zeros_like(reference.point)
        else:
            if table is None or not table.holds(sample, support.key, self.schedule.last):
                table = self._offsets(self.leg.chain, sample, support, footsteps, position)
            offset = table.values[sample - table.start :][: self.count]
        driving = replace(reference, point=reference.point - offset)
        return Window(sample, reference, driving, offset, height, stiffness, omega, table)

    def _offsets(
        self, chain: LegChain, sample: int, support: Support, footsteps: FootstepPlan, position: Array
    ) -> OffsetTable:
        """Offsets for a CoM on the nominal motion, which itself depends on them: two passes leave a millimetre."""
        count = min(self.count + _TICKS - 1, len(self.schedule.index) - sample)
        reference = self.zmp(sample, support, count)
        height = self.com_height(sample, support, reference)
        stiffness = softening(self.leg) * height.stiffness
        samples = np.maximum(np.arange(sample - 1, sample + count), 0)
        feet = nominal_feet(self.swing, footsteps, (support.rotation, support.origin), samples)
        offset = np.zeros_like(reference.point)
        for _ in range(2):
            motion = nominal_motion(position, reference.point - offset, stiffness, self.schedule.sample_time)
            offset = zmp_offset(chain, feet, motion, height, stiffness)
        return OffsetTable(sample, support.key, offset)
