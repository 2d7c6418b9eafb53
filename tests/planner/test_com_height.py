import numpy as np
import pytest

from planner.com_height import SmoothHeight, check_height, preview_height
from planner.gait import GaitParameters
from planner.schedule import schedule
from planner.types import GRAVITY

pytestmark = pytest.mark.unit

FINE = 1e-4


def stairs_preview():
    gait = GaitParameters(steps=3, single_support=0.6, double_support=0.3, initial_stand=0.1)
    plan = schedule(gait, FINE, 10)
    support = np.array([0.0, 0.0, 0.1, 0.2, 0.25])
    index, count = plan.index, len(plan.index)
    ground = support[index] + plan.fraction * np.append(np.diff(support), 0.0)[index]
    return preview_height(SmoothHeight().shape(gait, plan), 0, count, support, ground), ground, gait


def test_derivatives_are_those_of_the_height():
    z = stairs_preview()[0].height
    np.testing.assert_allclose(np.gradient(z[0], FINE)[1:-1], z[1][1:-1], atol=1e-5)
    np.testing.assert_allclose(np.gradient(z[1], FINE)[1:-1], z[2][1:-1], atol=1e-2)


def test_height_is_twice_continuously_differentiable():
    z = stairs_preview()[0].height
    assert np.abs(np.diff(z[0])).max() < 2.0 * FINE
    assert np.abs(np.diff(z[1])).max() < 10.0 * FINE
    assert np.abs(np.diff(z[2])).max() < 300.0 * FINE


def test_height_starts_and_ends_at_com_height_over_its_support_and_reaches_the_apex():
    preview, _, gait = stairs_preview()
    assert preview.height[0, 0] == pytest.approx(gait.com_height)
    assert preview.height[0, -1] == pytest.approx(gait.com_height + 0.25)
    middle = round((0.1 + 0.6 + 0.3) / FINE)
    assert preview.height[0, middle] == pytest.approx(gait.com_height + gait.apex_ss)


def test_stiffness_counts_the_height_above_the_zmp():
    preview, ground, _ = stairs_preview()
    np.testing.assert_allclose(
        preview.stiffness * (preview.height[0] - ground), GRAVITY + preview.height[2], rtol=1e-12
    )


def test_a_step_too_high_for_its_double_support_is_refused():
    gait = GaitParameters(steps=2, single_support=0.6, double_support=0.3)
    plan = schedule(gait, 0.02, 150)
    shape = SmoothHeight().shape(gait, plan)
    check_height(shape, plan, np.array([0.0, 0.0, 0.1, 0.1]))
    with pytest.raises(ValueError, match=r"falls off with -11\.\d m/s\^2.*double_support\.$"):
        check_height(shape, plan, np.array([0.0, 0.0, 0.18, 0.18]))
