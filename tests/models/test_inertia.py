import mujoco
import numpy as np
import pytest

from surefoot.models import inertia

pytestmark = pytest.mark.unit


@pytest.mark.parametrize(
    ("solid", "geom"),
    [
        (inertia.ellipsoid(2.0, (0.1, 0.2, 0.3)), 'type="ellipsoid" size="0.1 0.2 0.3"'),
        (inertia.sphere(2.0, 0.1), 'type="sphere" size="0.1"'),
        (inertia.cylinder(2.0, 0.1, 0.6), 'type="cylinder" size="0.1 0.3"'),
        (inertia.box(2.0, (0.2, 0.4, 0.6)), 'type="box" size="0.1 0.2 0.3"'),
    ],
)
def test_solids_have_the_moments_that_mujoco_integrates(solid: inertia.Inertial, geom: str) -> None:
    model = mujoco.MjModel.from_xml_string(
        f'<mujoco><worldbody><body><freejoint/><geom {geom} mass="2"/></body></worldbody></mujoco>'
    )
    rotation = np.zeros(9)
    mujoco.mju_quat2Mat(rotation, model.body_iquat[1])
    axes = rotation.reshape(3, 3)
    np.testing.assert_allclose(np.diag(axes @ np.diag(model.body_inertia[1]) @ axes.T), solid.moments, rtol=1e-12)


def test_two_halves_stacked_are_the_whole() -> None:
    lower = inertia.box(1.0, (0.2, 0.3, 0.25), (0.0, 0.0, 0.125))
    upper = inertia.box(1.0, (0.2, 0.3, 0.25), (0.0, 0.0, 0.375))
    whole = inertia.box(2.0, (0.2, 0.3, 0.5), (0.0, 0.0, 0.25))
    both = inertia.stacked(lower, upper)
    np.testing.assert_allclose((both.mass, *both.com, *both.moments), (whole.mass, *whole.com, *whole.moments))


def test_stacking_beside_the_axis_is_refused() -> None:
    with pytest.raises(ValueError, match="z axis"):
        inertia.stacked(inertia.sphere(1.0, 0.1), inertia.sphere(1.0, 0.1, (0.1, 0.0, 0.2)))


def test_point_mass_at_the_com_leaves_the_moments() -> None:
    solid = inertia.sphere(1.0, 0.1, (0.0, 0.0, 0.2))
    loaded = solid.with_point_mass(3.0)
    assert (loaded.mass, loaded.com, loaded.moments) == (4.0, solid.com, solid.moments)
