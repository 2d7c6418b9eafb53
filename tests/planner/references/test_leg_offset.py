"""The ZMP that the legs add, apart from any walk: on a standing robot whose CoM sways and sinks."""

import numpy as np
import pytest

from surefoot.planner.model.leg_chain import LegChain, Link
from surefoot.planner.parameters import LegInertia
from surefoot.planner.references.com_height import HeightPreview
from surefoot.planner.references.leg_offset import LegOffset
from surefoot.planner.steps.gait import GaitParameters
from surefoot.planner.types import GRAVITY

pytestmark = pytest.mark.unit

CHAIN = LegChain(
    0.1, (0.0, 0.0, 0.3), Link(0.43, 0.1, 0.33, 1.7e-3), Link(0.43, 0.04, 0.4, 6e-4), 0.02, (0.0, 0.0, -0.04),
    (0.0, 0.0, 0.08),
)  # fmt: skip


@pytest.fixture
def offsets(schedule):
    """The offset of 1.2 s of a sway, with a sample time, from a guess where there is one, shape (n, 2) [m]."""

    def made(sample_time, guess=None):
        count = round(1.2 / sample_time)
        t = sample_time * np.arange(count)
        standing = schedule(GaitParameters(steps=0), sample_time, after=2 * count)
        zmp = np.column_stack((0.02 + 0.06 * np.sin(7.0 * t), 0.05 * np.sin(7.0 * t))) * np.exp(-2.5 * t)[:, None]
        height = np.array([0.85 + 0.1 * t - 0.4 * t**2, 0.1 - 0.8 * t, np.full(count, -0.8)])
        preview = HeightPreview(height, (GRAVITY + height[2]) / height[0])
        law = LegOffset(LegInertia(mass_ratio=0.05, chain=CHAIN), 0.1, sample_time, count)
        moving = standing.samples, standing.schedule, (np.eye(2), np.zeros(2)), None
        return law.made(moving, zmp, preview, np.array([0.01, -0.02]), guess)

    return made


def test_the_offset_of_the_present_goes_on_as_that_of_what_is_to_come(offsets):
    """Its acceleration needs a sample before, which the motion is followed back to."""
    found = offsets(0.005)
    onward = 4.0 * found[1] - 6.0 * found[2] + 4.0 * found[3] - found[4]
    assert np.abs(found[:5]).max() > 4e-3
    np.testing.assert_allclose(found[0], onward, atol=5e-5)


def test_the_offset_of_the_present_does_not_depend_on_the_sample_time(offsets):
    np.testing.assert_allclose(offsets(0.02)[0], offsets(0.005)[0], atol=2e-5)


def test_two_passes_or_one_from_a_guess_leave_a_millimetre(offsets):
    """The motion that an offset is made for is driven by the ZMP less that offset."""
    found = offsets(0.02)
    for _ in range(8):
        found = offsets(0.02, found)
    assert np.abs(found).max() > 0.01
    np.testing.assert_allclose(offsets(0.02, found), found, atol=1e-3)
    np.testing.assert_allclose(offsets(0.02), found, atol=1e-3)
