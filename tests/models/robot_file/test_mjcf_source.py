"""A robot of an MJCF as MuJoCo compiles it: defaults, welded bodies, joints beside origins, motors of all kinds."""

from importlib.util import find_spec
from pathlib import Path

import biped
import mujoco
import numpy as np
import pinocchio as pin
import pytest

from surefoot.models import RobotError, RobotOptions, describe
from surefoot.models.consistency import EnginePair
from surefoot.models.convert import pinocchio_to_mujoco, velocity_map
from surefoot.models.pinocchio import pinocchio_model

pytestmark = pytest.mark.unit

LIMITS = "torque_limit: {'*_ankle_roll': 40}\nvelocity_limit: {'*': 12}\n"


def leg(side: str, sign: int) -> str:
    return f"""
      <body name="{side}_yaw_link" pos="0 {0.08 * sign} 0"><joint name="{side}_yaw" axis="0 0 1"/>
      <inertial pos="0 0 0" mass="0.5" diaginertia="1e-3 1e-3 1e-3"/>
      <body name="{side}_roll_link"><joint name="{side}_roll" axis="1 0 0"/>
      <inertial pos="0 0 0" mass="0.5" diaginertia="1e-3 1e-3 1e-3"/>
      <body name="{side}_thigh"><joint name="{side}_pitch" axis="0 1 0" armature="0.02"/>
      <geom type="capsule" fromto="0 0 -0.05 0 0 -0.25" size="0.04" density="900"/>
      <body name="{side}_shank" pos="0 0 -0.25" quat="0.8 0 0.6 0">
      <joint name="{side}_knee" axis="0 1 0" pos="0.048 0 -0.014" range="0.2 2"/>
      <body name="{side}_pad" quat="0.8 0 -0.6 0"><geom type="box" pos="0 0 -0.17" size="0.03 0.03 0.1"/>
      <body name="{side}_ankle" pos="0 0 -0.33"><joint name="{side}_ankle_pitch" axis="0 1 0"/>
      <inertial pos="0 0 0" mass="0.3" diaginertia="1e-3 1e-3 1e-3"/>
      <body name="{side}_foot"><joint name="{side}_ankle_roll" axis="1 0 0"/>
      <geom type="box" pos="0.03 0 -0.05" size="0.09 0.04 0.01"/></body></body></body></body></body></body></body>"""


MOTORS = "".join(
    f"""<motor joint="{side}_yaw" gear="50" ctrlrange="-1 1"/><motor joint="{side}_roll" forcerange="-60 60"/>
    <position joint="{side}_pitch" forcerange="-90 90" kp="100"/>
    <general joint="{side}_knee" forcerange="-80 80" gear="2"/>
    <motor joint="{side}_ankle_pitch" ctrlrange="-30 30"/>"""
    for side in ("left", "right")
)
TEXT = f"""<mujoco model="biped"><compiler angle="radian"/>
  <default><geom density="500"/><joint range="-1 1" limited="true"/></default>
  <worldbody><geom type="plane" size="1 1 1"/>
    <body name="base" pos="0 0 0.7"><freejoint/><geom type="box" size="0.08 0.1 0.08"/>
    {leg("left", 1)}{leg("right", -1)}</body></worldbody><actuator>{MOTORS}</actuator></mujoco>"""


def described(folder: Path, text: str = TEXT, limits: str = LIMITS):
    file = biped.FILE.replace("biped.urdf", "biped.xml") + limits
    return describe(str(biped.write(folder, text, file, "biped.xml")), RobotOptions())


def test_masses_and_forces_are_those_of_the_source(tmp_path) -> None:
    """Though a knee turns about a point beside its body's origin, from where the base of the source is the same."""
    robot, source = described(tmp_path), mujoco.MjModel.from_xml_string(TEXT)
    ours, data = pinocchio_model(robot), mujoco.MjData(source)
    rng = np.random.default_rng(0)
    for _ in range(50):
        q, v = EnginePair(robot).random_state(rng)
        pinocchio_to_mujoco(q, v, data.qpos, data.qvel)
        data.qvel[:] = 0.0
        mujoco.mj_forward(source, data)
        T, M = velocity_map(data.qpos, source.nv), np.zeros((source.nv, source.nv))
        mujoco.mj_fullM(source, data, M)
        np.testing.assert_allclose(T.T @ M @ T, pin.crba(ours, ours.createData(), q), atol=1e-9)
        np.testing.assert_allclose(
            T.T @ data.qfrc_bias, pin.computeGeneralizedGravity(ours, ours.createData(), q), atol=1e-9
        )
    assert EnginePair(robot).difference(q, v).largest < 1e-9


def test_torques_are_those_of_the_motors(tmp_path) -> None:
    robot = described(tmp_path)
    assert robot.torque_limit[:6] == pytest.approx((50, 60, 90, 160, 30, 40))
    assert robot.velocity_limit == pytest.approx(np.full(12, 12.0))


def test_a_knee_that_cannot_be_stretched_is_as_straight_as_it_gets(tmp_path) -> None:
    robot = described(tmp_path)
    assert robot.straight_joint_positions[robot.joint_names.index("left_knee")] == pytest.approx(0.2)


@pytest.mark.parametrize(
    ("change", "limits", "sentence"),
    [
        (("", ""), "velocity_limit: {'*': 12}\n", "'left_ankle_roll' and 1 more of biped have no torque limit"),
        (
            (
                "</worldbody>",
                f'<body name="other"><freejoint/><geom size="0.1"/>{leg("l", 1)}{leg("r", -1)}</body></worldbody>',
            ),
            LIMITS,
            "'base', 'other' in its world",
        ),
        (('type="plane"', 'type="plain"'), LIMITS, "biped.xml: .*mend it"),
        (('axis="1 0 0"/>', 'axis="1 0 0" ref="0.1"/>'), LIMITS, "joint 'left_roll' has a ref"),
        (('axis="0 0 1"/>', 'type="ball" limited="false"/>'), LIMITS, "'left_yaw' is neither hinge nor slide"),
    ],
)
def test_what_no_description_can_hold_is_refused(tmp_path, change, limits, sentence) -> None:
    with pytest.raises(RobotError, match=sentence):
        described(tmp_path, TEXT.replace(*change, 1) if change[0] else TEXT, limits)


@pytest.mark.skipif(find_spec("mjlab") is None, reason="needs the package mjlab, which has this MJCF")
def test_g1_of_an_mjcf_is_g1_of_its_urdf(tmp_path) -> None:
    model = "package://mjlab/asset_zoo/robots/unitree_g1/xmls/g1.xml"
    path = tmp_path / "g1.yaml"
    path.write_text(
        f"name: g1\nmodel: {model}\nfeet: {{left: left_ankle_roll_link, right: right_ankle_roll_link}}\n"
        "torque_limit: {'*': 50}\nvelocity_limit: {'*': 20}\n"
    )
    one, other = describe(str(path), RobotOptions()), describe("g1", RobotOptions())
    assert (one.joint_names, one.roles) == (other.joint_names, other.roles)
    assert (one.mass, one.leg_length, one.com_height) == pytest.approx(
        (other.mass, other.leg_length, other.com_height), rel=1e-3
    )
