"""The estimator slot of the controller, and noise and filter of what the planner is given."""

from collections.abc import Callable
from dataclasses import replace
from typing import TYPE_CHECKING, Any, Protocol

import numpy as np
from numpy.typing import NDArray

from surefoot.errors import ParameterError
from surefoot.parts.plugins import Registry
from surefoot.planner.model.filter import ZMP_ONLY, CentroidalFilter, FilterNoise
from surefoot.planner.plan.plan import WalkPlan
from surefoot.planner.types import GRAVITY, CentroidalState
from surefoot.readings import Readings
from surefoot.scenarios.file.registries import SOURCES
from surefoot.scenarios.file.sensing import Sensing
from surefoot.scenarios.record.walk import PlannerState
from surefoot.scenarios.setup.walk import Walk
from surefoot.sim.measurement import Measurement
from surefoot.similarity import REFERENCE_SIZE, Similarity
from surefoot.wbc.estimation.estimate import Estimate
from surefoot.wbc.types import RobotState

if TYPE_CHECKING:
    from surefoot.wbc.estimation.estimator import SensedState


class Estimator(Protocol):
    """A state estimator, asked once per control tick, from tick 0 on.

    Attributes:
        is_truth: whether it hands on the true state, so that the record of the truth needs no kinematics of its own.
    """

    is_truth: bool

    def estimate(self, measurement: Measurement) -> RobotState | Estimate:
        """The state now, or that with what else the estimator knows.

        Args:
            measurement: of this tick; its arrays are overwritten by the next, and `q` and `v` are the truth, which an
                honest estimator looks at only at tick 0.
        """
        ...


class TrueState:
    """No estimation: the true state. The default.

    Args:
        walk: what is run.
        options: of a scenario, of which it takes none.

    Raises:
        ParameterError: there are options.
    """

    is_truth = True

    def __init__(self, walk: Walk, **options: Any) -> None:
        """Nothing is needed of the walk."""
        if options:
            what = f"sensing.options of the true state, which takes none: {', '.join(options)}"
            raise ParameterError(("sensing", "options"), what, "leave them out, or let sensing.source name another")
        self._state: RobotState | None = None

    def estimate(self, measurement: Measurement) -> RobotState:
        """See `Estimator`."""
        state = self._state
        if state is None or state.q is not measurement.q or state.v is not measurement.v:
            self._state = state = RobotState(measurement.q, measurement.v)
        return state


class SensorEstimator(Protocol):
    """A state estimator that sees nothing but what sensors say, asked once per control tick, from tick 0 on.

    It may have a method ``told``, which is given what the controller has decided after each tick, as a
    `surefoot.wbc.estimation.estimate.Planned`.
    """

    def sense(self, readings: Readings) -> Estimate:
        """The state now, and what else the estimator knows.

        Args:
            readings: of this tick.
        """
        ...


EstimatorMaker = Callable[..., Estimator | SensorEstimator]


def ekf(walk: Walk, **options: Any) -> "SensedState":
    """An invariant Kalman filter of IMU, encoders and feet.

    It is imported when it is made; arguments are those of `scenarios.run.ekf.sensed_state`.
    """
    from surefoot.scenarios.run.ekf import sensed_state

    return sensed_state(walk, **options)


ESTIMATORS: Registry[EstimatorMaker] = SOURCES
"""Makers of an estimator from a walk and ``sensing.options``, by the value of ``sensing.source``."""


Array = NDArray[np.float64]

VELOCITY_NOISE = 5.0
"""Standard deviation of the measured CoM velocity over that of the measured CoM; with a unit of the reference robot, as
all here [1/s]."""

CLIP = 2.0
"""Standard deviations at which noise is clipped: with 0.01 m it stays within the paper's 0.02 m."""

LEAST_ZMP_DEVIATION = 0.01
"""The filter trusts no ZMP more than this: swinging limbs move it by some millimetres that the model lacks [m]."""

LEAST_COM_DEVIATION = 1e-4
"""The filter trusts no CoM more than this, so that its covariance keeps an inverse [m]."""

_PRIOR = (0.01, 0.01, 0.05)
"""Deviation of the robot's start from standing still over the middle of its feet [m, m/s, m/s^2]."""

_STREAM = 1
"""Random numbers of the measurement, apart from those of the start pose with the same seed."""


class PlannerSensing:
    """Noisy measurement and filter of a walk.

    Horizontal CoM position, velocity and ZMP are noisy; the CoM height needs no measurement, since the planner uses its
    own. One Gaussian sample per plan, clipped; always as many are drawn, so that one noise does not change another.

    Args:
        walk: its sensing, its filter, its seed, and where the feet stand at the start.
    """

    def __init__(self, walk: Walk) -> None:
        sensing = walk.sensing
        com = sensing.com_noise
        speed = walk.size.times(VELOCITY_NOISE, "1/s") * com
        self._deviation = np.repeat([sensing.zmp_noise, com, speed], 2).reshape(3, 2)
        self._noisy = bool(self._deviation.any())
        self._rng = np.random.default_rng(np.random.SeedSequence(walk.seed, spawn_key=(_STREAM,)))
        self._filter, self._nothing = _filter(walk), np.full(2, np.nan)
        self._ground = float(walk.ground.stance.position[:, 2].mean())

    def sense(self, state: CentroidalState, zmp: Array, plan: WalkPlan | None) -> PlannerState:
        """Measure, and estimate from all measurements so far.

        Args:
            state: CoM as the planner's robot model has it, without noise.
            zmp: ZMP without noise, shape (2,) [m]; NaN when the feet carry no load.
            plan: what has been done since the last measurement, None at the first.
        """
        measured, measured_zmp = self._disturbed(state, zmp) if self._noisy else (state, zmp)
        kalman, com, velocity = self._filter, measured.com, measured.com_velocity
        if kalman is None:
            return PlannerState(measured, measured_zmp, measured, self._nothing, self._nothing)
        self._estimate(kalman, measured, measured_zmp, plan)
        x, v, a = kalman.mean
        given = replace(state, com=np.append(x, com[2]), com_velocity=np.append(v, velocity[2]))
        innovation = kalman.innovation
        return PlannerState(measured, measured_zmp, given, a, np.full(2, np.nan) if innovation is None else innovation)

    def _disturbed(self, state: CentroidalState, zmp: Array) -> tuple[CentroidalState, Array]:
        """State and ZMP with noise."""
        # numpy.clip and numpy.append take ten times as long.
        noise = self._deviation * np.minimum(np.maximum(self._rng.standard_normal((3, 2)), -CLIP), CLIP)
        com, velocity = state.com.copy(), state.com_velocity.copy()
        com[:2] += noise[1]
        velocity[:2] += noise[2]
        return replace(state, com=com, com_velocity=velocity), zmp + noise[0]

    def _estimate(self, kalman: CentroidalFilter, measured: CentroidalState, zmp: Array, plan: WalkPlan | None) -> None:
        if plan is None:
            stiffness, offset = GRAVITY / (float(measured.com[2]) - self._ground), np.zeros(2)
        else:
            done = round((measured.time - plan.time) / plan.sample_time)
            kalman.predict(plan.jerk[done - 1] if done <= len(plan.jerk) else np.zeros(2))
            now = min(done, len(plan.jerk))
            stiffness, offset = float(plan.stiffness[now]), plan.zmp_offset[now]
        kalman.update(zmp - offset, measured.com[:2], measured.com_velocity[:2], stiffness)


def _filter(walk: Walk) -> CentroidalFilter | None:
    """The walk's filter, believing that the robot stands still over the middle of its feet."""
    if walk.filter == "none":
        return None
    mean = np.zeros((3, 2))
    mean[0] = walk.ground.stance.position[:, :2].mean(axis=0)
    noise, prior = filter_noise(walk.sensing, walk.size), walk.size.times(_PRIOR, "m, m/s, m/s^2")
    sensors = ZMP_ONLY if walk.filter == "zmp_only" else (True, True, True)
    return CentroidalFilter(walk.parameters.sample_time, noise, mean, prior, sensors)


def filter_noise(sensing: Sensing, size: Similarity = REFERENCE_SIZE) -> FilterNoise:
    """The noise that the filter counts on: the sensors' own, at least what the model of a robot of a size promises."""
    com = max(sensing.com_noise, LEAST_COM_DEVIATION * size.length)
    zmp = max(sensing.zmp_noise, LEAST_ZMP_DEVIATION * size.length)
    return replace(size.scaled(FilterNoise()), zmp=zmp, com=com, com_velocity=size.times(VELOCITY_NOISE, "1/s") * com)
