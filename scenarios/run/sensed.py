"""The estimator of a scenario's sensors: what it counts on of them, and how it is asked, told and recorded."""

import math
from collections.abc import Callable, Mapping
from dataclasses import fields, is_dataclass, replace
from typing import Any

import numpy as np
import pinocchio as pin

from surefoot.errors import ParameterError
from surefoot.guard import Guard, MisfitError
from surefoot.models.pinocchio import pinocchio_model
from surefoot.models.types import RobotDescription
from surefoot.planner.types import CentroidalState, FeetState
from surefoot.readings import Readings
from surefoot.scenarios.setup.parts import ESTIMATE, guarded
from surefoot.scenarios.setup.walk import Walk
from surefoot.sim.measurement import Measurement
from surefoot.sim.sensor_errors import SensorErrors
from surefoot.wbc.estimation.estimate import Deviation, Estimate, Planned
from surefoot.wbc.estimation.estimator import SensedState
from surefoot.wbc.estimation.footing import Footing, ImuMount
from surefoot.wbc.estimation.parameters import ContactDetection, EstimatorParameters, GroundNoise, SensorNoise
from surefoot.wbc.estimation.torques import TorqueWrench
from surefoot.wbc.types import NONE_TOUCHES, Array, FootSensing, WbcReference, WbcReport

_OPTIONS = ("sensing", "options")


def sensed_state(walk: Walk, **options: Any) -> SensedState:
    """An invariant Kalman filter of IMU, encoders and feet.

    It knows of a walk's sensors no more than their data sheets say.

    Args:
        walk: what is run.
        options: fields of `EstimatorParameters`, groups as mappings.

    Raises:
        ParameterError: there is no such option, or its value is out of range.
    """
    robot, ground, size = walk.robot, walk.ground, walk.size
    period, stance = 1.0 / walk.rates.control, ground.stance
    usual = EstimatorParameters(
        sensor_noise(walk.hardware.sensors, period), size.scaled(GroundNoise()), size.scaled(ContactDetection())
    )

    def height(x: float, y: float) -> float:
        return float(ground.terrain.height(x, y))

    def normal(x: float, y: float) -> Array:
        return np.asarray(ground.terrain.normal(x, y))

    # On a line the CoP is where the line is.
    leaning = 0.5 * robot.sole_width if robot.roles.feet_lean else None
    half_size = 0.5 * robot.sole_length, math.inf if leaning is not None else 0.5 * robot.sole_width
    footing = Footing(stance.position.copy(), np.array(stance.yaw), half_size, height, normal, leaning)
    parameters = _with(usual, options, _OPTIONS)
    return SensedState(pinocchio_model(robot), robot.sole_sites, imu_mount(robot), footing, period, parameters)


def imu_mount(robot: RobotDescription) -> ImuMount:
    """Where a robot's IMU is, in the estimator's terms."""
    place = robot.imu
    turned = pin.Quaternion(*place.quaternion).matrix()
    return ImuMount(place.body, place.position, tuple(map(tuple, turned.tolist())))


def sensor_noise(errors: SensorErrors, period: float) -> SensorNoise:
    """What an estimator counts on of sensors with these errors.

    Args:
        errors: of the sensors.
        period: control period [s].
    """
    rounding = math.tau / 2**errors.encoder_bits / math.sqrt(12.0) if errors.encoder_bits else 0.0
    root = math.sqrt(period)
    return SensorNoise(
        gyro_density=math.hypot(errors.gyro_density, errors.gyro_noise * root),
        gyro_bias=errors.gyro_bias,
        gyro_walk=errors.gyro_walk,
        accelerometer_density=math.hypot(errors.accelerometer_density, errors.accelerometer_noise * root),
        accelerometer_bias=errors.accelerometer_bias,
        accelerometer_walk=errors.accelerometer_walk,
        mounting=errors.imu_misalignment,
        encoder=math.hypot(errors.encoder_noise, rounding),
        encoder_offset=errors.encoder_offset,
        joint_torque=errors.joint_torque_noise,
        wrench_force=errors.wrench_noise,
        wrench_moment=errors.moment_noise,
        wrench_bias=errors.wrench_bias,
    )


def _with(parameters: Any, options: Mapping[str, Any], key: tuple[str, ...]) -> Any:
    """A dataclass with some of its fields replaced, those that are groups by mappings of theirs."""
    named = {entry.name: getattr(parameters, entry.name) for entry in fields(parameters)}
    changed = {}
    for name, value in options.items():
        at = (*key, name)
        if name not in named:
            raise ParameterError(at, f"unknown option '{name}'", f"choose from {', '.join(named)}")
        group = named[name]
        if is_dataclass(group) and not isinstance(value, Mapping):
            raise ParameterError(at, f"{name} is {value!r}", "give its numbers by name")
        changed[name] = _with(group, value, at) if is_dataclass(group) else value
    try:
        return replace(parameters, **changed)
    except ParameterError as error:
        raise ParameterError((*key, error.key[-1]), error.what, error.right) from None


class Senses:
    """An estimator of either kind, asked the same way: one that is given the measurement, or one that senses.

    Args:
        estimator: made of the walk, not yet behind its guard.
        guard: of its package.

    Attributes:
        is_truth: whether it hands on the true state.
        reads: whether it is given what sensors say, in place of the measurement.
        listens: whether it wants to know what was decided; see `told`.

    Raises:
        MisfitError: it is of neither kind.
    """

    def __init__(self, estimator: Any, guard: Guard) -> None:
        self.reads, told = callable(getattr(estimator, "sense", None)), callable(getattr(estimator, "told", None))
        if not self.reads and not callable(getattr(estimator, "estimate", None)):
            raise MisfitError("has neither a method sense nor a method estimate")
        part = guarded(estimator, guard, ESTIMATE)
        self.is_truth = not self.reads and bool(part.is_truth)
        if self.reads:
            self._sense = part.sense
        else:
            self._estimate = part.estimate
        self._last: Estimate | None = None
        self._told: Callable[[Planned], None] | None = part.told if self.reads and told else None
        self.listens = self._told is not None

    def __call__(self, readings: Readings | Measurement) -> Estimate:
        """The estimate of a tick, with the wrenches of the sensors where the estimator has none of its own.

        Raises:
            ParameterError: it is given what an estimator of the other kind needs.
        """
        if self.reads != isinstance(readings, Readings):
            wanted = "what sensors say, as surefoot.Readings" if self.reads else "the state, as surefoot.Measurement"
            raise ParameterError(("readings",), f"a {type(readings).__name__} for this estimator", f"give {wanted}")
        if isinstance(readings, Measurement):
            state, wrench, last = self._estimate(readings), readings.wrench, self._last
            # A world that measures into the same arrays, and a state of these, make the same estimate.
            if last is None or last.state is not state or last.wrench is not wrench:
                self._last = last = Estimate(state, wrench)
            return last
        estimate: Estimate = self._sense(readings)
        felt = readings.wrench
        if estimate.wrench is not None or felt is None:
            return estimate
        return replace(estimate, wrench=felt.values, wrench_age=felt.age)

    def told(self, reference: WbcReference, report: WbcReport) -> None:
        """Tell the estimator what was decided, if it wants to know."""
        if self._told is not None:
            self.decided(
                Planned(report.acceleration.copy(), report.torque.copy(), report.active, reference.rolling_foot)
            )

    def decided(self, planned: Planned) -> None:
        """Tell the estimator what somebody else has decided, if it wants to know."""
        if self._told is not None:
            self._told(planned)


def foot_sensing(
    estimate: Estimate,
    wrench: Array,
    wanted: bool,
    inferred: TorqueWrench | None = None,
    touching: tuple[bool, bool] = NONE_TOUCHES,
) -> FootSensing:
    """What the feet feel.

    Args:
        estimate: of this tick.
        wrench: of the soles, shape (2, 6) [N, N·m].
        wanted: whether a lasting force is to be found.
        inferred: what makes these wrenches of the joints' torques, for an estimate that tells none; None of wrenches
            that are felt.
        touching: see `FootSensing`.
    """
    deviation, age, sure = (0.0, 0.0), estimate.wrench_age, estimate.deviation
    if inferred is not None:
        deviation, age = inferred.deviation, age + inferred.late
    if sure is not None:
        deviation = sure.force, sure.moment
    forces = wrench.item(2), wrench.item(8)
    return FootSensing(forces, wrench if wanted else None, estimate.contact, deviation, age, touching)


def unsure(deviation: Deviation, state: CentroidalState, feet: FeetState) -> tuple[CentroidalState, FeetState]:
    """State and feet with how sure they are."""
    com, velocity = float(np.hypot(*deviation.com[:2])), float(np.hypot(*deviation.com_velocity[:2]))
    return replace(state, deviation=(com, velocity)), replace(feet, height_deviation=deviation.step_height)
