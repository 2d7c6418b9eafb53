"""The place of a model's IMU: the link or site that the file names, else one of the trunk that is called so."""

import pinocchio as pin

from surefoot.engines.mimic import moving_columns
from surefoot.models.robot_file.reduced import Reduced
from surefoot.models.robot_file.schema import RobotFile
from surefoot.models.types import ImuPlace, RobotError, nearest

CALLED = "imu"
"""Part of the name of a link or a site that is an IMU, in any case of letters."""

_PLACES = (pin.FrameType.BODY, pin.FrameType.OP_FRAME)
"""Links, and sites of an MJCF."""


def find_imu(reduced: Reduced, file: RobotFile, torso: int) -> tuple[ImuPlace, str]:
    """Place of the IMU, and what it was found by.

    Args:
        reduced: the model.
        file: of the robot.
        torso: joint of the torso; IMUs of limbs are passed over unless the file names one.

    Raises:
        RobotError: the file names nothing of the model, or what is between a joint and its follower.
    """
    model = reduced.model
    frames = [frame for frame in model.frames if frame.type in _PLACES and frame.parentJoint > 0]
    if file.imu is not None:
        names = tuple(frame.name for frame in frames)
        if file.imu not in names:
            what = f"imu of {file.name} names '{file.imu}', which is no link or site of it"
            raise RobotError(("imu",), what, nearest(file.imu, names))
        found = [frames[names.index(file.imu)]]
    else:
        trunk = list(model.supports[torso])
        found = [frame for frame in frames if CALLED in frame.name.lower() and frame.parentJoint in trunk]
    if not found:
        return ImuPlace(), "imu: none in the model, so at the frame of the floating base"
    frame = min(found, key=lambda one: len(model.supports[one.parentJoint]))
    try:
        moving_columns(model, frame.parentJoint)
    except ValueError as error:
        what = f"imu of {file.name} is '{frame.name}', between two joints that turn as one"
        raise RobotError(("imu",), what, "name a link above or below both") from error
    body = reduced.bodies[frame.parentJoint - 1]
    at, turn = frame.placement.translation, pin.Quaternion(frame.placement.rotation).normalized()
    x, y, z = (float(value) for value in at)
    place = ImuPlace(
        None if frame.parentJoint == 1 else body,
        (x, y, z),
        (float(turn.w), float(turn.x), float(turn.y), float(turn.z)),
    )
    by = "as given" if file.imu is not None else "by its name"
    return place, f"imu: {frame.name} on {body} at {x:.3f}, {y:.3f}, {z:.3f} m, {by}"
