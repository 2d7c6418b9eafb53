"""Feet that lean with their shanks: the line on which they stand, and what the QP asks of them there."""

from dataclasses import replace

import numpy as np
import pinocchio as pin
import pytest

from surefoot.planner.geometry.orientation import sole_rotation
from surefoot.wbc.body.leaning import FREE, INWARD, line_centre, line_frame
from surefoot.wbc.body.model import RobotTerms
from surefoot.wbc.body.statics import standing_torque
from surefoot.wbc.contact.cone import TOE_DEPTH
from surefoot.wbc.types import FootSensing, RobotState, SolveStatus

pytestmark = pytest.mark.unit

HALF, LEAN = 0.02, 0.15


@pytest.fixture
def leaning(robot):
    """humanoid100 with feet that count as leaning, standing with both ankles rolled outward."""
    standing = robot.standing.copy()
    for side, sign in (("left", -1.0), ("right", 1.0)):
        standing[robot.model.joints[robot.model.getJointId(f"{side}_ankle_roll")].idx_q] += sign * LEAN
    return replace(robot, frames=replace(robot.frames, leaning=HALF), standing=standing)


@pytest.mark.parametrize("foot", [0, 1])
@pytest.mark.parametrize("pitch", [0.0, 0.2])
def test_the_line_is_level_and_its_edge_the_lower_one_of_a_foot_that_leans_outward(foot, pitch):
    outward = (1.0, -1.0)[foot]
    R = sole_rotation(0.4, pitch, -outward * LEAN)
    frame = line_frame(foot, R, HALF)
    level = R @ frame.rotation
    assert level[2, 1] == pytest.approx(0.0, abs=1e-12)
    np.testing.assert_allclose(level[:, 0], R[:, 0], atol=1e-12)
    np.testing.assert_allclose(frame.translation, [0.0, outward * HALF, 0.0])
    centre = line_centre(foot, np.zeros(3), R, HALF)
    assert centre[2] == pytest.approx(-HALF * np.sin(LEAN) * np.cos(pitch))


@pytest.mark.parametrize("foot", [0, 1])
def test_the_line_goes_over_to_the_inner_edge_without_a_jump(foot):
    outward = (1.0, -1.0)[foot]
    angles = np.linspace(-0.3, 0.3, 601)
    beside = [line_frame(foot, sole_rotation(0.0, 0.0, outward * a), HALF).translation[1] for a in angles]
    assert beside[0] == outward * HALF
    assert beside[-1] == -outward * HALF
    assert beside[int(np.argmin(np.abs(angles - INWARD)))] == pytest.approx(0.0, abs=1e-9)
    assert np.abs(np.diff(beside)).max() < 0.1 * HALF


def test_a_leaning_foot_is_seen_from_its_line(leaning):
    terms = RobotTerms(leaning.model, leaning.frames)
    terms.update(leaning.standing, np.zeros(leaning.nv))
    lines = terms.level_soles(0.0, 0.0)
    to_sole = terms.shift_foot(0, 0.0, 0.0)
    np.testing.assert_allclose(terms.contact_position[0], lines[0], atol=1e-12)
    assert terms.contact_rotation[0][2, 1] == pytest.approx(0.0, abs=1e-12)
    # A force through the line has about the sole's centre the moment of its lever.
    moment = to_sole @ np.array([0.0, 0.0, 1.0, 0.0, 0.0, 0.0])
    assert moment[3] == pytest.approx(HALF * np.cos(LEAN), rel=0.02)


def test_the_qp_leaves_the_roll_free_and_asks_no_moment_about_the_line(leaning, references, loaded):
    standing, _ = references
    controller = leaning.controller()
    controller.observe(RobotState(leaning.standing, np.zeros(leaning.nv)))
    report = controller.update(standing(zmp=np.array([0.0, 0.02])), loaded)
    assert report.status is SolveStatus.SOLVED
    terms, kept = controller.terms, [row for row in range(6) if row != FREE]
    motion = terms.sole_jacobian @ report.acceleration + terms.sole_bias
    # What turns them back level in pitch is all that is asked of the others.
    np.testing.assert_allclose(motion[:, kept], 0.0, atol=1e-4)
    for k in (0, 1):
        R, wrench = terms.sole_rotation[k], report.wrench[k]
        line = line_frame(k, R, HALF)
        at_line = line.toDualActionMatrix()
        there = np.linalg.solve(at_line, wrench)
        assert there[2] > 20.0
        assert there[FREE] == pytest.approx(0.0, abs=1e-4)
    # An ordinary foot is held flat.
    plain = replace(leaning, frames=replace(leaning.frames, leaning=None)).controller()
    plain.observe(RobotState(leaning.standing, np.zeros(leaning.nv)))
    held = plain.update(standing(zmp=np.array([0.0, 0.02])), loaded)
    turned = plain.terms.sole_jacobian @ held.acceleration + plain.terms.sole_bias
    assert np.abs(turned[:, FREE]).min() > 1.0  # levelling


def test_the_commanded_zmp_stays_on_the_line(leaning, references):
    _, swing = references
    controller = leaning.controller()
    terms = controller.observe(RobotState(leaning.standing, np.zeros(leaning.nv)))
    contacts = replace(controller.schedule.update(swing(), _carried()), active=(True, False))
    controller.build(terms, swing(), contacts)
    line = terms.contact_position[0]
    x, y = controller.region.project(line[0], line[1] + 1.0)
    assert abs(y - line[1]) <= TOE_DEPTH
    assert x == pytest.approx(line[0], abs=1e-6)


def test_the_swing_task_leaves_the_roll_to_the_leg(leaning, references):
    controller = leaning.controller()
    swing = next(task for task in controller.tasks.layout if task[0] == "swing foot")
    first = sum(size for name, size in controller.tasks.layout[: controller.tasks.layout.index(swing)])
    _, reference = references
    terms = controller.observe(RobotState(leaning.standing, np.zeros(leaning.nv)))
    contacts = replace(controller.schedule.update(reference(), _carried()), active=(True, False))
    controller.build(terms, reference(), contacts)
    rows = controller.tasks.rows[first : first + 6]
    assert not rows[FREE].any()
    assert np.abs(rows[[0, 1, 2, 4, 5]]).max(axis=1).min() > 0.0


def test_standing_on_lines_takes_no_moment_about_them(leaning):
    model, data, q = leaning.model, leaning.model.createData(), leaning.standing
    rest = pin.computeGeneralizedGravity(model, data, q).copy()
    rest[6:] -= standing_torque(model, leaning.frames, q)
    pin.computeJointJacobians(model, data, q)
    pin.updateFramePlacements(model, data)
    rows = []
    for k, name in enumerate(leaning.frames.soles):
        frame = model.getFrameId(name)
        line = line_frame(k, data.oMf[frame].rotation, HALF).toActionMatrixInverse()
        J = line @ pin.getFrameJacobian(model, data, frame, pin.ReferenceFrame.LOCAL)
        rows.append(np.delete(J, FREE, axis=0))
    transposed = np.vstack(rows).T
    wrench = np.linalg.lstsq(transposed, rest, rcond=None)[0]
    np.testing.assert_allclose(transposed @ wrench, rest, atol=1e-6)


def _carried():
    return FootSensing((900.0, 0.0))
