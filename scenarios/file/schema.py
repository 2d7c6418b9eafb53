"""The keys of a scenario file: types, units, bounds and defaults.

One frozen model per group. Every key has a default, so a scenario file states only what it changes. What
relates several keys (rates that divide, steps within reach) is checked in ``checks``.
"""

from typing import Annotated, Literal

from pydantic import BeforeValidator, Field

from surefoot.scenarios.file.criteria import Bound, standing_walk
from surefoot.scenarios.file.group import (
    DEFAULTS,
    ControllerSettings,
    Finite,
    Group,
    OneOf,
    as_tuple,
    estimators,
    profiles,
    terrain_kinds,
)

LONGEST_RUN = 86_400.0
"""Bound on the simulated time [s]."""

NonNegative = Annotated[float, Field(ge=0, allow_inf_nan=False)]
Positive = Annotated[float, Field(gt=0, allow_inf_nan=False)]
FootSize = Annotated[float, Field(ge=0.01, le=0.5)]
Angle = Annotated[float, Field(ge=-6.3, le=6.3, allow_inf_nan=False)]
Place = Annotated[float, Field(ge=-1e6, le=1e6, allow_inf_nan=False)]
Speed = Annotated[float, Field(ge=-10, le=10, allow_inf_nan=False)]
Noise = Annotated[float, Field(ge=0, le=0.1, allow_inf_nan=False)]
NAME = r"^[A-Za-z0-9][A-Za-z0-9._-]*$"
Rate = Annotated[int, Field(ge=1, le=100_000)]
Vector = Annotated[tuple[Finite, Finite, Finite], BeforeValidator(as_tuple)]


class RobotSettings(Group):
    """What of the robot may be changed."""

    foot_length: FootSize | None = Field(default=None, description="sole length, null: the robot's own [m]")
    foot_width: FootSize | None = Field(default=None, description="sole width, null: the robot's own [m]")
    payload_mass: Annotated[float, Field(ge=0, le=1000, allow_inf_nan=False)] = Field(
        default=0.0, description="mass carried [kg]"
    )
    payload_body: str | None = Field(default=None, description="body that carries it, null: the torso")


class TerrainSettings(Group):
    """The ground."""

    kind: Annotated[str, OneOf(DEFAULTS["terrain"], terrain_kinds)] = Field(
        default=DEFAULTS["terrain"], description="shape of the ground"
    )
    riser: NonNegative = Field(
        default=0.1, description="height of a stair, or how much higher or lower a block may be [m]"
    )
    tread: Positive = Field(default=0.3, description="depth of a stair, or length of a block [m]")
    count: Annotated[int, Field(ge=1, le=1000)] = Field(default=5, description="number of stairs [-]")
    direction: Literal["up", "down", "up_down"] = Field(default="up", description="which way the stairs go")
    start: Finite | None = Field(
        default=None,
        description="start to the first riser, null: footsteps land in mid-tread, a little behind it if the "
        "foot_length that robot_options gives leaves room; or to the edge of a slope, null: half a step [m]",
    )
    landing: Positive | None = Field(default=None, description="depth between up and down, null: three treads [m]")
    height_noise: NonNegative = Field(
        default=0.0,
        description="half range by which the true height of each tread or block differs from the planner's belief [m]",
    )
    angle: Angle = Field(
        default=0.0, description="inclination of a slope, negative downhill, or largest pitch and roll of a block [rad]"
    )
    friction: Annotated[float, Field(ge=0, le=10, allow_inf_nan=False)] = Field(
        default=0.8, description="Coulomb coefficient of every surface [-]"
    )


class VelocitySettings(Group):
    """A velocity command, in force from its time until the next one; all zero is standing."""

    time: Annotated[float, Field(ge=0, le=LONGEST_RUN, allow_inf_nan=False)] = Field(description="from when on [s]")
    v_x: Speed = Field(default=0.0, description="forward velocity of the path [m/s]")
    v_y: Speed = Field(default=0.0, description="velocity to the left [m/s]")
    yaw_rate: Speed = Field(default=0.0, description="rate of its heading, left positive [rad/s]")


class FootstepSettings(Group):
    """A footstep, in the frame between the start feet, x along their heading."""

    foot: Literal["left", "right"] = Field(description="foot that steps; they must take turns")
    x: Place = Field(description="sole centre, forward [m]")
    y: Place = Field(description="sole centre, to the left [m]")
    yaw: Annotated[float, Field(ge=-1e3, le=1e3, allow_inf_nan=False)] = Field(
        default=0.0, description="heading of the sole, whole turns counted [rad]"
    )


class Gait(Group):
    """The walk that is asked for; defaults are the paper's table."""

    steps: Annotated[int, Field(ge=0, le=100_000)] = Field(default=5, description="footsteps to take [-]")
    step_length: Finite = Field(default=0.2, description="forward distance between successive footsteps [m]")
    step_width: Positive = Field(default=0.2, description="lateral distance between the feet's centres [m]")
    lateral_step: Finite = Field(default=0.0, description="lateral progress of each footstep, left positive [m]")
    turn: Angle = Field(default=0.0, description="heading change of each footstep, left positive [rad]")
    single_support: Positive = Field(default=1.5, description="duration of a single support [s]")
    double_support: Positive = Field(default=0.5, description="duration of a double support [s]")
    swing_height: Annotated[float, Field(gt=0, le=0.5, allow_inf_nan=False)] = Field(
        default=0.05, description="apex of the swing foot above the ground [m]"
    )
    com_height: Positive = Field(default=1.0, description="CoM height above the soles [m]")
    initial_stand: NonNegative = Field(default=1.0, description="standing before the first weight shift [s]")
    apex_single: NonNegative = Field(
        default=0.0135, description="apex of the CoM rise in single support, A_ss of the paper [m]"
    )
    apex_double: NonNegative = Field(
        default=0.00135, description="apex of the CoM rise in double support, A_ds of the paper [m]"
    )
    velocity: Annotated[tuple[VelocitySettings, ...], BeforeValidator(as_tuple)] = Field(
        default=(), description="velocity commands over time, in place of equal steps; the last one must stop"
    )
    footsteps: Annotated[tuple[FootstepSettings, ...], BeforeValidator(as_tuple)] = Field(
        default=(), description="every footstep, in place of equal steps"
    )
    heel_off: Annotated[float, Field(ge=0, le=1.0, allow_inf_nan=False)] = Field(
        default=0.0, description="greatest pitch of a foot about its toes after its stance, 0: feet stay level [rad]"
    )


class PlannerSettings(Group):
    """The walking planner."""

    profile: Annotated[str, OneOf(DEFAULTS["planner"], profiles)] = Field(
        default=DEFAULTS["planner"], description="formulation of the planner"
    )
    horizon: Annotated[int, Field(ge=2, le=1000)] | None = Field(
        default=None, description="samples of the horizon, N_p, null: the profile's own [-]"
    )
    control_horizon: Annotated[int, Field(ge=1, le=1000)] | None = Field(
        default=None, description="moves of the jerk, one per sample, N_c, null: the profile's own blocks [-]"
    )
    sample_time: Positive = Field(default=0.02, description="sample time of the horizon, and of replanning [s]")
    jerk_limit: Positive | None = Field(
        default=None, description="bound on the CoM jerk, null: the profile's own [m/s^3]"
    )
    jerk_rate_limit: Positive | None = Field(
        default=None, description="bound on its change per sample, null: the profile's own [m/s^3]"
    )
    step_adaptation: Literal["none", "location", "timing"] = Field(
        default="location", description="what of the next footstep the planner may change"
    )
    knee: Literal["stretched", "bent"] = Field(
        default="stretched", description="CoM height: the paper's rises, or constant and 0.08 m lower"
    )
    rise: Literal["single", "double"] | None = Field(
        default=None, description="support phase in which the CoM climbs, null: double on a pendulum, single for legs"
    )
    filter: Literal["none", "kalman", "zmp_only"] | None = Field(
        default=None, description="filter of the planner's state, null: kalman when ZMP or CoM are noisy, else none"
    )


class Sensing(Group):
    """What planner and controller know of the robot; noises are standard deviations."""

    source: Annotated[str, OneOf(DEFAULTS["sensing"], estimators)] = Field(
        default=DEFAULTS["sensing"], description="estimator of the state that controller and planner are given"
    )
    zmp_noise: NonNegative = Field(default=0.0, description="of the ZMP that the planner measures [m]")
    com_noise: NonNegative = Field(
        default=0.0, description="of the CoM that the planner measures [m]; of its velocity 5 / s times as much"
    )
    encoder_noise: NonNegative = Field(default=0.0, description="of the joint encoders [rad]")
    gyro_noise: NonNegative = Field(default=0.0, description="of the gyroscope [rad/s]")
    accelerometer_noise: NonNegative = Field(default=0.0, description="of the accelerometer [m/s^2]")
    wrench_noise: NonNegative = Field(default=0.0, description="of the foot force sensors [N]")
    latency: NonNegative = Field(default=0.0, description="age of the measurement [s]")


class Start(Group):
    """Where the robot starts; noises are half ranges drawn from the seed."""

    x: Place = Field(default=0.0, description="world position forward [m]")
    y: Place = Field(default=0.0, description="world position left [m]")
    yaw: Angle = Field(default=0.0, description="heading about the world's z axis [rad]")
    position_noise: Noise = Field(default=0.0, description="random offset of the base, soles flat on the ground [m]")
    angle_noise: Noise = Field(default=0.0, description="random offset of base and joint angles, soles flat [rad]")


class GroundError(Group):
    """A box on the ground that neither planner nor controller knows of, in the frame of the start, x ahead."""

    x: Place = Field(description="middle, forward of the start [m]")
    y: Place = Field(default=0.0, description="middle, to the left [m]")
    length: Annotated[float, Field(gt=0, le=100, allow_inf_nan=False)] = Field(description="forward [m]")
    width: Annotated[float, Field(gt=0, le=100, allow_inf_nan=False)] = Field(default=2.0, description="sideways [m]")
    height: Annotated[float, Field(gt=0, le=1, allow_inf_nan=False)] = Field(
        description="of its top over the ground at the start [m]"
    )


class BeliefErrors(Group):
    """The planner's belief minus the truth."""

    com_height: Annotated[float, Field(ge=-0.4, le=0.4, allow_inf_nan=False)] = Field(
        default=0.0, description="error of the CoM height [m]"
    )
    mass_scale: Annotated[float, Field(ge=0.5, le=2.0, allow_inf_nan=False)] = Field(
        default=1.0, description="believed over true mass [-]"
    )
    friction: Finite = Field(default=0.0, description="error of the friction coefficient [-]")
    ground: Annotated[tuple[GroundError, ...], BeforeValidator(as_tuple)] | None = Field(
        default=None, description="boxes on the ground that are not believed in, null: none"
    )


class PushSettings(Group):
    """A force on a body, beginning at a time or at a point of the gait."""

    time: NonNegative | None = Field(default=None, description="begin [s]; or give step, phase and fraction")
    step: Annotated[int, Field(ge=1)] | None = Field(default=None, description="footstep, 1 is the first [-]")
    phase: Literal["single", "double"] | None = Field(
        default=None, description="its support phase; double precedes single"
    )
    fraction: Annotated[float, Field(ge=0, le=1)] | None = Field(
        default=None, description="elapsed share of the phase [-]"
    )
    duration: Positive = Field(default=0.1, description="how long the force acts [s]")
    force: Vector = Field(default=(0.0, 0.0, 0.0), description="force in the world frame [N]")
    body: str | None = Field(default=None, description="body it acts on, at its centre of mass; null: the torso")


class PendulumSettings(Group):
    """The plant of fidelity pendulum."""

    plant: Literal["pendulum", "cart_table"] = Field(
        default="pendulum",
        description="the true pendulum, or the paper's cart-table that does any jerk and cannot fall",
    )
    feedback: NonNegative = Field(
        default=3.0, description="gain of the pendulum's ZMP on its true DCM's error, the low level's part [-]"
    )


class Fault(Group):
    """A fault injected for negative controls."""

    kind: Literal["torque_loss", "planner_freeze", "state_nan", "qp_failure"] = Field(
        description="zero torque; plan not updated; NaN in the measured state; QP solver reports failure"
    )
    time: NonNegative = Field(default=0.0, description="begin [s]")
    duration: Positive | None = Field(default=None, description="how long, null: to the end [s]")


class Rates(Group):
    """Rates of the one integer clock; each must divide the one before."""

    physics: Rate = Field(default=1000, description="simulator steps [Hz]")
    control: Rate = Field(default=500, description="whole-body controller ticks [Hz]")
    planner: Rate = Field(default=50, description="plans [Hz]; 1 / planner.sample_time")


class Scenario(Group):
    """A walk to simulate and the criteria it must meet."""

    name: str = Field(
        default="scenario", min_length=1, max_length=100, pattern=r"^[A-Za-z0-9][A-Za-z0-9._-]*$", description="name"
    )
    robot: str = Field(default=DEFAULTS["robot"], description="name of a robot, see `surefoot list`")
    fidelity: Literal["full", "pendulum"] = Field(
        default="full", description="whole body in MuJoCo, or the pendulum alone"
    )
    seed: Annotated[int, Field(ge=0, lt=2**32)] = Field(default=0, description="seed of everything random [-]")
    duration: Annotated[float, Field(gt=0, le=LONGEST_RUN, allow_inf_nan=False)] | None = Field(
        default=None, description="simulated time, null: until the gait has ended [s]"
    )
    robot_options: RobotSettings = Field(default=RobotSettings(), description="changes to the robot")
    terrain: TerrainSettings = Field(default=TerrainSettings(), description="the ground")
    gait: Gait = Field(default=Gait(), description="the walk")
    planner: PlannerSettings = Field(default=PlannerSettings(), description="the planner")
    sensing: Sensing = Field(default=Sensing(), description="the sensors")
    start: Start = Field(default=Start(), description="the start pose")
    errors: BeliefErrors = Field(default=BeliefErrors(), description="the planner's belief minus the truth")
    wbc: ControllerSettings | None = Field(default=None, description="the whole-body controller, null: as it is")
    pendulum: PendulumSettings = Field(default=PendulumSettings(), description="the plant of fidelity pendulum")
    pushes: Annotated[tuple[PushSettings, ...], BeforeValidator(as_tuple)] = Field(
        default=(), description="disturbances"
    )
    faults: Annotated[tuple[Fault, ...], BeforeValidator(as_tuple)] = Field(default=(), description="injected faults")
    rates: Rates = Field(default=Rates(), description="the clock")
    criteria: dict[str, Bound] = Field(default_factory=standing_walk, description="bounds on metrics")
