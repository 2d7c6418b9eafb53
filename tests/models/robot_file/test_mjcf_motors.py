"""The torque and the rotor of a joint are those that MuJoCo gives it by all of its actuators together."""

import itertools

import mujoco
import numpy as np
import pinocchio as pin
import pytest
from mjcf_biped import TEXT, described
from mjcf_elements import read_text, source_text

from surefoot.models import RobotError
from surefoot.models.consistency import EnginePair
from surefoot.models.convert import pinocchio_to_mujoco, velocity_map
from surefoot.models.pinocchio import pinocchio_model

pytestmark = pytest.mark.unit

SETS = {
    "one": '<motor joint="left_knee" ctrlrange="-30 30" gear="3"/>',
    "two": '<motor joint="left_knee" forcerange="-150 150" ctrlrange="-900 900"/>'
    '<motor joint="left_knee" ctrlrange="-50 50"/>',
    "against each other": '<motor joint="left_knee" ctrlrange="0 70"/>'
    '<motor joint="left_knee" ctrlrange="0 40" gear="-2"/>',
    "force and control": '<motor joint="left_knee" ctrlrange="-1 1" gear="20" forcerange="-60 60"/>',
    "in the parent": '<motor jointinparent="left_knee" ctrlrange="-30 30"/>',
    "general": '<general joint="left_knee" gainprm="2" ctrlrange="-10 20"/>',
    "filtered": '<general joint="left_knee" gainprm="2" ctrlrange="-10 10" dyntype="filterexact" dynprm="0.01"/>',
    "cylinder": '<cylinder joint="left_knee" ctrlrange="-2 2" area="3"/>',
    "none": '<motor joint="left_knee" ctrlrange="-30 30" gear="0"/><motor joint="left_knee" ctrlrange="-1 1"/>',
}
OWN = '<general joint="left_knee" forcerange="-80 80" gear="2"/>'


def at_the_ends(text: str, joint: str) -> tuple[float, float]:
    """Least and greatest torque of a joint over all ends of all controls, once they have acted for long [N m]."""
    mj = mujoco.MjModel.from_xml_string(text)
    data, dof = mujoco.MjData(mj), mj.joint(joint).dofadr[0]
    ends = [
        tuple(row) if limited else (-1e6, 1e6)
        for row, limited in zip(mj.actuator_ctrlrange, mj.actuator_ctrllimited, strict=True)
    ]
    acting = [at for at in range(mj.nu) if mj.actuator_trnid[at, 0] == mj.joint(joint).id]
    found = []
    for chosen in itertools.product(*(ends[at] for at in acting)):
        data.ctrl[acting] = chosen
        for at, control in zip(acting, chosen, strict=True):
            if mj.actuator_actnum[at]:
                data.act[mj.actuator_actadr[at]] = control
        mujoco.mj_forward(mj, data)
        found.append(float(data.qfrc_actuator[dof]))
    return min(found), max(found)


@pytest.mark.parametrize("kind", SETS)
@pytest.mark.parametrize("bound", ["", ' actuatorfrcrange="-45 45"'])
def test_the_limit_of_a_joint_is_the_torque_that_it_has_both_ways(tmp_path, kind, bound):
    text = source_text(change=(OWN, SETS[kind])).replace('<joint name="left_knee"', f'<joint name="left_knee"{bound}')
    found = read_text(tmp_path, text)
    model = found.model
    least, most = at_the_ends(text, "left_knee")
    limit = model.upperEffortLimit[model.joints[model.getJointId("left_knee")].idx_v]
    assert limit == pytest.approx(min(-least, most))
    unlike = [line for line in found.left_out if "larger of unlike torques" in line]
    assert [("left_knee" in line) for line in unlike] == ([] if least == pytest.approx(-most) else [True])


@pytest.mark.parametrize("second", ['<position joint="left_knee" kp="9"/>', '<motor joint="left_knee"/>'])
def test_beside_a_motor_without_a_bound_another_ones_bound_says_nothing(tmp_path, second):
    with pytest.raises(RobotError, match="joint 'left_knee' of biped has no torque limit"):
        read_text(tmp_path, source_text(f"<actuator>{second}</actuator>"))


def test_rotors_of_motors_are_inertias_of_their_joints(tmp_path):
    text = TEXT.replace('<motor joint="left_yaw" gear="50"', '<motor joint="left_yaw" gear="50" armature="1e-4"')
    robot, source = described(tmp_path, text), mujoco.MjModel.from_xml_string(text)
    ours, data = pinocchio_model(robot), mujoco.MjData(source)
    q, v = EnginePair(robot).random_state(np.random.default_rng(0))
    pinocchio_to_mujoco(q, v, data.qpos, data.qvel)
    mujoco.mj_forward(source, data)
    T, M = velocity_map(data.qpos, source.nv), np.zeros((source.nv, source.nv))
    mujoco.mj_fullM(source, data, M)
    np.testing.assert_allclose(T.T @ M @ T, pin.crba(ours, ours.createData(), q), atol=1e-9)
    assert ours.armature[ours.joints[ours.getJointId("left_yaw")].idx_v] == pytest.approx(0.25)
