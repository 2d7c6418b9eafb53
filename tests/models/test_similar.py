"""A robot and its similar one of another size move alike, once times are scaled."""

from dataclasses import replace

import numpy as np
import pinocchio as pin
import pytest

from surefoot.models import RobotError, RobotOptions, describe
from surefoot.models.consistency import EnginePair
from surefoot.models.pinocchio import pinocchio_model
from surefoot.models.similar import scaled

ROBOT = describe("humanoid100", RobotOptions())


@pytest.mark.unit
@pytest.mark.parametrize("factor", [0.25, 0.5, 1.5])
def test_the_same_share_of_the_limits_gives_the_similar_motion(factor):
    similar = scaled(ROBOT, factor)
    one, other = pinocchio_model(ROBOT), pinocchio_model(similar)
    rng = np.random.default_rng(0)
    q, v, a = pin.randomConfiguration(one, -np.ones(one.nq), np.ones(one.nq)), *rng.normal(size=(2, one.nv))
    q2, v2, a2 = q.copy(), v / np.sqrt(factor), a / factor  # angles; then per time, per time squared
    q2[:3] *= factor
    v2[:3] *= factor
    a2[:3] *= factor
    torque = pin.rnea(one, one.createData(), q, v, a)[6:] / ROBOT.torque_limit
    torque2 = pin.rnea(other, other.createData(), q2, v2, a2)[6:] / similar.torque_limit
    np.testing.assert_allclose(torque2, torque, rtol=0, atol=1e-9)
    np.testing.assert_allclose(v2[6:] / similar.velocity_limit, v[6:] / ROBOT.velocity_limit, rtol=1e-12)


@pytest.mark.unit
def test_both_engines_read_the_similar_robot_alike():
    pair = EnginePair(scaled(ROBOT, 0.5))
    rng = np.random.default_rng(1)
    assert max(pair.difference(*pair.random_state(rng)).largest for _ in range(5)) < 1e-9


@pytest.mark.unit
def test_no_length_of_the_text_is_left_behind():
    pair, similar = EnginePair(ROBOT).mj_model, EnginePair(scaled(ROBOT, 0.5)).mj_model
    for field in ("body_pos", "body_ipos", "geom_pos", "geom_size", "site_pos", "jnt_pos"):
        np.testing.assert_allclose(getattr(similar, field), 0.5 * getattr(pair, field), atol=1e-14)
    np.testing.assert_allclose(similar.actuator_forcerange, 0.5**4 * pair.actuator_forcerange)


@pytest.mark.unit
@pytest.mark.parametrize("factor", [0.0, -1.0, float("inf"), float("nan")])
def test_a_size_that_is_none_is_refused(factor):
    with pytest.raises(RobotError, match="scaled by"):
        scaled(ROBOT, factor)


@pytest.mark.unit
def test_a_size_at_which_a_link_has_no_moment_is_refused():
    """MuJoCo would not read it; one a little larger it does."""
    small = scaled(ROBOT, 0.01)
    light = 'mass="1e-9" diaginertia="1e-13 1e-13 1e-13"'
    text = small.mjcf.replace("<inertial ", f'<inertial pos="0 0 0" {light}/><nothing ', 1)
    with pytest.raises(RobotError, match=r"link '.*' of humanoid100 has a moment of 1e-18 kg m\^2 at the scale 0\.1"):
        scaled(replace(small, mjcf=text), 0.1)
    assert EnginePair(small)
