"""The place of a robot file's IMU: by its key, by its name, or else at the floating base."""

import biped
import numpy as np
import pinocchio as pin
import pytest

from surefoot.models import RobotError, RobotOptions, describe, explain
from surefoot.models.types import ImuPlace

pytestmark = pytest.mark.unit


def link(name, parent, at="0.01 -0.02 0.03", rpy="0 0 0"):
    return (
        f'<link name="{name}"/><joint name="{name}_fixed" type="fixed"><parent link="{parent}"/><child link="{name}"/>'
        f'<origin xyz="{at}" rpy="{rpy}"/></joint>'
    )


def place(tmp_path, extra, file=biped.FILE, **changes):
    path = biped.write(tmp_path, biped.Biped(extra=extra, **changes), file)
    return describe(str(path), RobotOptions()).imu, explain(str(path))


def test_without_one_it_is_the_frame_of_the_base(tmp_path):
    imu, said = place(tmp_path, "")
    assert imu == ImuPlace()
    assert "imu: none in the model, so at the frame of the floating base" in said.derived


def test_a_link_that_is_called_so_is_it(tmp_path):
    imu, said = place(tmp_path, link("Head_IMU", "base"))
    assert imu == ImuPlace(None, (0.01, -0.02, 0.03), (1.0, 0.0, 0.0, 0.0))
    assert "imu: Head_IMU on base at 0.010, -0.020, 0.030 m, by its name" in said.derived


def test_those_of_limbs_are_passed_over_unless_the_file_names_one(tmp_path):
    extra = link("foot_imu", "left_foot") + link("imu", "base", "0 0 0.1")
    assert place(tmp_path, extra)[0].position == (0.0, 0.0, 0.1)
    named, said = place(tmp_path, extra, biped.FILE + "imu: foot_imu\n")
    assert (named.body, named.position) == ("left_foot", (0.01, -0.02, 0.03))
    assert any(line.startswith("imu: foot_imu on left_foot") and line.endswith("as given") for line in said.derived)


def test_any_link_may_be_named(tmp_path):
    assert place(tmp_path, "", biped.FILE + "imu: left_shank\n")[0] == ImuPlace("left_shank")


def test_a_name_of_nothing_is_refused(tmp_path):
    with pytest.raises(RobotError, match="imu of biped names 'hat', which is no link or site of it") as refused:
        place(tmp_path, "", biped.FILE + "imu: hat\n")
    assert refused.value.key == ("imu",)


def test_it_stays_where_it_is_when_the_base_is_turned_to_face_ahead(tmp_path):
    """The base of this model looks back, and the IMU is to be in the front of it."""
    imu, _ = place(tmp_path, link("imu", "base", "-0.05 0 0.2", "0 0 1"), turned=True)
    np.testing.assert_allclose(imu.position, (0.05, 0.0, 0.2), atol=1e-12)
    turn = pin.Quaternion(*np.array(imu.quaternion)).toRotationMatrix()
    np.testing.assert_allclose(turn, pin.rpy.rpyToMatrix(0.0, 0.0, 1.0 - np.pi), atol=1e-12)


def test_it_grows_with_the_robot_and_comes_back_from_the_cache(tmp_path):
    extra = link("imu", "base")
    double, _ = place(tmp_path, extra, biped.FILE + "scale: 2\n")
    assert double.position == pytest.approx((0.02, -0.04, 0.06))
    again, _ = place(tmp_path, extra, biped.FILE + "scale: 2\n")
    assert again == double


def test_a_site_of_an_mjcf_may_be_it(tmp_path):
    leg = (
        '<body name="{s}_yaw" pos="0 {y} 0"><inertial pos="0 0 0" mass="1" diaginertia="0.01 0.01 0.01"/>'
        '<joint name="{s}_yaw_j" axis="0 0 1" range="-1 1"/>'
        '<body name="{s}_roll"><inertial pos="0 0 0" mass="1" diaginertia="0.01 0.01 0.01"/>'
        '<joint name="{s}_roll_j" axis="1 0 0" range="-1 1"/>'
        '<body name="{s}_thigh"><inertial pos="0 0 -0.15" mass="2" diaginertia="0.02 0.02 0.01"/>'
        '<joint name="{s}_pitch_j" axis="0 1 0" range="-1.5 1.5"/>'
        '<geom type="box" size="0.03 0.03 0.1" pos="0 0 -0.15"/>'
        '<body name="{s}_shank" pos="0 0 -0.3"><inertial pos="0 0 -0.15" mass="2" diaginertia="0.02 0.02 0.01"/>'
        '<joint name="{s}_knee_j" axis="0 1 0" range="0 2"/><geom type="box" size="0.03 0.03 0.1" pos="0 0 -0.15"/>'
        '<body name="{s}_ankle" pos="0 0 -0.3"><inertial pos="0 0 0" mass="0.2" diaginertia="0.001 0.001 0.001"/>'
        '<joint name="{s}_ap_j" axis="0 1 0" range="-1 1"/>'
        '<body name="{s}_foot"><inertial pos="0 0 -0.03" mass="0.5" diaginertia="0.001 0.001 0.001"/>'
        '<joint name="{s}_ar_j" axis="1 0 0" range="-1 1"/><geom type="box" size="0.09 0.04 0.01" pos="0.03 0 -0.05"/>'
        "</body></body></body></body></body></body>"
    )
    legs = leg.format(s="left", y=0.08) + leg.format(s="right", y=-0.08)
    names = [
        f"{side}_{joint}_j" for side in ("left", "right") for joint in ("yaw", "roll", "pitch", "knee", "ap", "ar")
    ]
    motors = "".join(f'<motor joint="{name}" ctrlrange="-80 80" ctrllimited="true"/>' for name in names)
    (tmp_path / "m.xml").write_text(
        '<mujoco><compiler angle="radian" autolimits="true"/><worldbody><body name="base" pos="0 0 1"><freejoint/>'
        '<inertial pos="0 0 0.05" mass="8" diaginertia="0.1 0.1 0.1"/>'
        '<geom type="box" size="0.1 0.1 0.1" pos="0 0 0.15"/>'
        f'<site name="imu_site" pos="0.04 0 0.1" quat="0 0 0 1"/>{legs}</body></worldbody><actuator>{motors}</actuator>'
        "</mujoco>"
    )
    path = tmp_path / "m.yaml"
    path.write_text("name: m\nmodel: m.xml\nfeet: {left: left_foot, right: right_foot}\n")
    assert describe(str(path), RobotOptions()).imu == ImuPlace(None, (0.04, 0.0, 0.1), (0.0, 0.0, 0.0, 1.0))


def test_shipped_robots_have_theirs():
    bodies = {name: describe(name, RobotOptions()).imu for name in ("g1", "talos", "alexander")}
    assert {name: imu.body for name, imu in bodies.items()} == {"g1": None, "talos": "torso_2_link", "alexander": None}
    assert bodies["g1"].position == pytest.approx((0.04525, 0.0, -0.08339))
