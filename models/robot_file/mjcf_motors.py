"""The motors of a compiled MJCF: torque and rotor that all actuators of a joint give it together."""

from collections.abc import Iterator

import numpy as np

from surefoot.engines.windowless import mujoco

_OF_JOINT = (int(mujoco.mjtTrn.mjTRN_JOINT), int(mujoco.mjtTrn.mjTRN_JOINTINPARENT))
_FILTERED = tuple(
    int(kind) for kind in (mujoco.mjtDyn.mjDYN_NONE, mujoco.mjtDyn.mjDYN_FILTER, mujoco.mjtDyn.mjDYN_FILTEREXACT)
)
"""Dynamics of an actuator whose activation stays within the range of its control."""


def actuators_of(mj: mujoco.MjModel, joint: int) -> Iterator[int]:
    """Actuators that act on a joint itself."""
    for actuator in range(len(mj.actuator_trntype)):
        if int(mj.actuator_trntype[actuator]) in _OF_JOINT and mj.actuator_trnid[actuator, 0] == joint:
            yield actuator


def torques(mj: mujoco.MjModel, joint: int) -> tuple[float, float]:
    """Least and greatest torque of a joint, those of its actuators added up; both 0 where one has no bound [N m]."""
    ranges = [_torques(mj, actuator) for actuator in actuators_of(mj, joint)]
    lower, upper = (sum(bounds) for bounds in zip(*ranges, strict=True)) if ranges else (-np.inf, np.inf)
    if mj.jnt_actfrclimited[joint]:
        least, most = mj.jnt_actfrcrange[joint]
        lower, upper = max(lower, least), min(upper, most)
    return (float(lower), float(upper)) if np.isfinite(lower) and np.isfinite(upper) else (0.0, 0.0)


def rotor(mj: mujoco.MjModel, joint: int) -> float:
    """Inertia of the rotors of a joint's actuators, seen from the joint [kg m^2]."""
    found = actuators_of(mj, joint)
    return float(sum(mj.actuator_gear[actuator, 0] ** 2 * mj.actuator_armature[actuator] for actuator in found))


def _torques(mj: mujoco.MjModel, actuator: int) -> tuple[float, float]:
    """Least and greatest torque that an actuator gives its joint; infinite without a bound [N m]."""
    lower, upper = -np.inf, np.inf
    if mj.actuator_forcelimited[actuator]:
        lower, upper = mj.actuator_forcerange[actuator]
    control = int(mj.actuator_ctrladr[actuator])
    if _is_direct(mj, actuator) and mj.actuator_ctrlnum[actuator] == 1 and mj.actuator_ctrllimited[control]:
        least, most = sorted(mj.actuator_gainprm[actuator, 0] * mj.actuator_ctrlrange[control])
        lower, upper = max(lower, least), min(upper, most)
    gear = float(mj.actuator_gear[actuator, 0])
    least, most = sorted((gear * lower, gear * upper)) if gear else (0.0, 0.0)
    return least, most


def _is_direct(mj: mujoco.MjModel, actuator: int) -> bool:
    """Return true if the force is the control, filtered, times a constant gain."""
    gain, bias = int(mj.actuator_gaintype[actuator]), int(mj.actuator_biastype[actuator])
    constant = gain == int(mujoco.mjtGain.mjGAIN_FIXED) or (
        gain == int(mujoco.mjtGain.mjGAIN_AFFINE) and not mj.actuator_gainprm[actuator, 1:].any()
    )
    unbiased = bias == int(mujoco.mjtBias.mjBIAS_NONE) or (
        bias == int(mujoco.mjtBias.mjBIAS_AFFINE) and not mj.actuator_biasprm[actuator].any()
    )
    return constant and unbiased and int(mj.actuator_dyntype[actuator]) in _FILTERED
