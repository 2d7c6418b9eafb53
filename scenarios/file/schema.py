"""The keys of a scenario file: types, units, bounds and defaults.

One frozen model per group. Every key has a default, so a scenario file states only what it changes. What
relates several keys (rates that divide, steps within reach) is checked in ``checks``.
"""

from contextlib import suppress
from typing import Annotated, Any, Literal

from pydantic import BaseModel, BeforeValidator, Field, SerializeAsAny

from surefoot.plugins import PluginError
from surefoot.scenarios.file.criteria import Bound, standing_walk
from surefoot.scenarios.file.group import (
    DEFAULTS,
    WHOLE,
    ControllerSettings,
    Group,
    OneOf,
    RecoverySettings,
    as_tuple,
    estimators,
    profiles,
    terrain_kinds,
)
from surefoot.scenarios.file.units import (
    HERTZ,
    KILOGRAM,
    METRE,
    METRE_PER_SECOND,
    NEWTON,
    RADIAN,
    RADIAN_PER_SECOND,
    SECOND,
    Unit,
)

LONGEST_RUN = 86_400.0
"""Bound on the simulated time [s]."""

NonNegative = Annotated[float, Field(ge=0, le=1e9, allow_inf_nan=False)]
Positive = Annotated[float, Field(gt=0, le=1e9, allow_inf_nan=False)]
FootSize = Annotated[float, Field(ge=0.01, le=0.5), METRE]
Angle = Annotated[float, Field(ge=-6.3, le=6.3, allow_inf_nan=False), RADIAN]
Place = Annotated[float, Field(ge=-1e6, le=1e6, allow_inf_nan=False), METRE]
Length = Annotated[float, Field(ge=-1e3, le=1e3, allow_inf_nan=False), METRE]
Size = Annotated[float, Field(gt=0, le=1e3, allow_inf_nan=False), METRE]
Height = Annotated[float, Field(ge=0, le=1e3, allow_inf_nan=False), METRE]
Support = Annotated[float, Field(gt=0, le=60, allow_inf_nan=False), SECOND]
Span = Annotated[float, Field(gt=0, le=LONGEST_RUN, allow_inf_nan=False), SECOND]
Instant = Annotated[float, Field(ge=0, le=LONGEST_RUN, allow_inf_nan=False), SECOND]
Speed = Annotated[float, Field(ge=-10, le=10, allow_inf_nan=False)]
Noise = Annotated[float, Field(ge=0, le=0.1, allow_inf_nan=False)]
NAME = r"^[A-Za-z0-9][A-Za-z0-9._-]*$"
Rate = Annotated[int, Field(ge=1, le=100_000), WHOLE, HERTZ]
Newtons = Annotated[float, Field(ge=-1e6, le=1e6, allow_inf_nan=False), NEWTON]
Force = Annotated[tuple[Newtons, Newtons, Newtons], BeforeValidator(as_tuple)]
Offset = Annotated[float, Field(ge=-0.5, le=0.5, allow_inf_nan=False), METRE]
Impulse = Annotated[float, Field(ge=0, le=100, allow_inf_nan=False), Unit("N·s/kg")]
Live = Annotated[bool, Field(description="given by hand while a run went on, so that it need not act for a pass")]


class RobotSettings(Group):
    """What of the robot may be changed."""

    foot_length: FootSize | None = Field(default=None, description="sole length, null: the robot's own")
    foot_width: FootSize | None = Field(default=None, description="sole width, null: the robot's own")
    payload_mass: Annotated[float, Field(ge=0, le=1000, allow_inf_nan=False), KILOGRAM] = Field(
        default=0.0, description="mass carried"
    )
    payload_body: str | None = Field(default=None, description="body that carries it, null: the torso")


class TerrainSettings(Group):
    """The ground."""

    kind: Annotated[str, OneOf(DEFAULTS["terrain"], terrain_kinds)] = Field(
        default=DEFAULTS["terrain"], description="shape of the ground"
    )
    riser: Height = Field(default=0.1, description="height of a stair, or how much higher or lower a block may be")
    tread: Size = Field(default=0.3, description="depth of a stair, or length of a block")
    count: Annotated[int, Field(ge=1, le=1000), WHOLE] = Field(default=5, description="number of stairs [-]")
    direction: Literal["up", "down", "up_down"] = Field(default="up", description="which way the stairs go")
    start: Length | None = Field(
        default=None,
        description="start to the first riser, null: footsteps land in mid-tread, a little behind it if the "
        "foot_length that robot_options gives leaves room; or to the edge of a slope, null: half a step",
    )
    landing: Size | None = Field(default=None, description="depth between up and down, null: three treads")
    height_noise: Height = Field(
        default=0.0,
        description="half range by which the true height of each tread or block differs from the planner's belief",
    )
    angle: Angle = Field(
        default=0.0, description="inclination of a slope, negative downhill, or largest pitch and roll of a block"
    )
    friction: Annotated[float, Field(ge=0, le=10, allow_inf_nan=False)] = Field(
        default=0.8, description="Coulomb coefficient of every surface [-]"
    )


def model_of(model: type[BaseModel], values: Any) -> type[BaseModel]:
    """The model of a group with these values: of the ground, the one that its kind brings if it has keys of its own.

    Args:
        model: of the group, as the schema has it.
        values: plain ones, of which any may be wrong.
    """
    kind = values.get("kind") if model is TerrainSettings and isinstance(values, dict) else None
    if not isinstance(kind, str) or kind == DEFAULTS["terrain"]:
        return model
    with suppress(LookupError, PluginError):
        own = terrain_kinds()[kind].settings
        return own if isinstance(own, type) and issubclass(own, TerrainSettings) else model
    return model


def _by_its_kind(values: Any) -> Any:
    own = model_of(TerrainSettings, values)
    return values if own is TerrainSettings else own.model_validate(values)


class VelocitySettings(Group):
    """A velocity command, in force from its time until the next one; all zero is standing."""

    time: Instant = Field(description="from when on")
    v_x: Annotated[Speed, METRE_PER_SECOND] = Field(default=0.0, description="forward velocity of the path")
    v_y: Annotated[Speed, METRE_PER_SECOND] = Field(default=0.0, description="velocity to the left")
    yaw_rate: Annotated[Speed, RADIAN_PER_SECOND] = Field(default=0.0, description="rate of its heading, left positive")


class FootstepSettings(Group):
    """A footstep, in the frame between the start feet, x along their heading."""

    foot: Literal["left", "right"] = Field(description="foot that steps; they must take turns")
    x: Place = Field(description="sole centre, forward")
    y: Place = Field(description="sole centre, to the left")
    yaw: Annotated[float, Field(ge=-1e3, le=1e3, allow_inf_nan=False), RADIAN] = Field(
        default=0.0, description="heading of the sole, whole turns counted"
    )


class PlaceSettings(Group):
    """A place to go to, with the heading there."""

    x: Place = Field(description="middle of the stance, forward")
    y: Place = Field(description="middle of the stance, to the left")
    yaw: Annotated[float, Field(ge=-1e3, le=1e3, allow_inf_nan=False), RADIAN] = Field(
        default=0.0, description="heading"
    )


class CommandSettings(Group):
    """What the walk is told while it goes on; the planner does not know of it before."""

    time: Instant = Field(description="when")
    v_x: Annotated[Speed, METRE_PER_SECOND] | None = Field(
        default=None, description="forward velocity from then on, null: 0, or as it was if no velocity is given"
    )
    v_y: Annotated[Speed, METRE_PER_SECOND] | None = Field(default=None, description="velocity to the left, likewise")
    yaw_rate: Annotated[Speed, RADIAN_PER_SECOND] | None = Field(
        default=None, description="rate of the heading, likewise"
    )
    place: PlaceSettings | None = Field(
        default=None, description="where to go, in the world frame, in place of a velocity"
    )
    single_support: Support | None = Field(default=None, description="duration from then on, null: as it was")
    double_support: Support | None = Field(default=None, description="duration from then on, null: as it was")
    swing_height: Annotated[float, Field(gt=0, le=0.5, allow_inf_nan=False), METRE] | None = Field(
        default=None, description="apex of the swing foot from then on, null: as it was"
    )
    live: Live = False

    def superseded_by(self, other: "CommandSettings") -> set[str]:
        """Keys of this one that a later one leaves without effect, if nothing comes between them."""
        given, others = ({name for name, value in one if value is not None} for one in (self, other))
        leads = _LEADING & given if _LEADING & others else set()
        return leads | given & others - _LEADING - {"time", "live"}


_LEADING = {"v_x", "v_y", "yaw_rate", "place"}
"""Keys of a command that say where to walk, each of which replaces all."""


class Gait(Group):
    """The walk that is asked for; defaults are the paper's table."""

    steps: Annotated[int, Field(ge=0, le=100_000), WHOLE] = Field(default=5, description="footsteps to take [-]")
    step_length: Length = Field(
        default=0.2,
        description="forward distance between successive footsteps, and at most that of a walk to a place; on stairs, "
        "unless given, terrain.tread",
    )
    step_width: Size = Field(default=0.2, description="lateral distance between the feet's centres")
    lateral_step: Length = Field(default=0.0, description="lateral progress of each footstep, left positive")
    turn: Angle = Field(default=0.0, description="heading change of each footstep, left positive")
    single_support: Support = Field(default=1.5, description="duration of a single support")
    double_support: Support = Field(default=0.5, description="duration of a double support")
    swing_height: Annotated[float, Field(gt=0, le=0.5, allow_inf_nan=False), METRE] = Field(
        default=0.05, description="apex of the swing foot above the ground"
    )
    com_height: Size = Field(default=1.0, description="CoM height above the soles")
    initial_stand: Instant = Field(default=1.0, description="standing before the first weight shift")
    apex_single: Height = Field(default=0.0135, description="apex of the CoM rise in single support, A_ss of the paper")
    apex_double: Height = Field(
        default=0.00135, description="apex of the CoM rise in double support, A_ds of the paper"
    )
    velocity: Annotated[tuple[VelocitySettings, ...], BeforeValidator(as_tuple)] = Field(
        default=(), description="velocity commands over time, in place of equal steps; the last one must stop"
    )
    footsteps: Annotated[tuple[FootstepSettings, ...], BeforeValidator(as_tuple)] = Field(
        default=(), description="every footstep, in place of equal steps"
    )
    waypoints: Annotated[tuple[PlaceSettings, ...], BeforeValidator(as_tuple)] = Field(
        default=(),
        description="places to go to one after another and to stand at the last one, with strides of at most "
        "step_length, in the frame between the start feet; in place of equal steps",
    )
    heel_off: Annotated[float, Field(ge=0, le=1.0, allow_inf_nan=False), RADIAN] = Field(
        default=0.0, description="greatest pitch of a foot about its toes after its stance, 0: feet stay level"
    )


class PlannerSettings(Group):
    """The walking planner."""

    profile: Annotated[str, OneOf(DEFAULTS["planner"], profiles)] = Field(
        default=DEFAULTS["planner"], description="formulation of the planner"
    )
    horizon: Annotated[int, Field(ge=2, le=1000), WHOLE] | None = Field(
        default=None, description="samples of the horizon, N_p, null: the profile's own [-]"
    )
    control_horizon: Annotated[int, Field(ge=1, le=1000), WHOLE] | None = Field(
        default=None, description="moves of the jerk, one per sample, N_c, null: the profile's own blocks [-]"
    )
    sample_time: Annotated[float, Field(ge=1e-5, le=1, allow_inf_nan=False), SECOND] = Field(
        default=0.02, description="sample time of the horizon, and of replanning"
    )
    jerk_limit: Annotated[Positive, Unit("m/s^3")] | None = Field(
        default=None, description="bound on the CoM jerk, null: the profile's own"
    )
    jerk_rate_limit: Annotated[Positive, Unit("m/s^3")] | None = Field(
        default=None, description="bound on its change per sample, null: the profile's own"
    )
    step_adaptation: Literal["none", "location", "timing", "crossing"] = Field(
        default="crossing",
        description="what of the next footsteps a push may change: where, when, beyond the stance foot",
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
    recovery: RecoverySettings | None = Field(
        default=None, description="numbers of its recovery from pushes, null: as they are"
    )


class Sensing(Group):
    """What planner and controller know of the robot; noises are standard deviations."""

    source: Annotated[str, OneOf(DEFAULTS["sensing"], estimators)] = Field(
        default=DEFAULTS["sensing"], description="estimator of the state that controller and planner are given"
    )
    zmp_noise: Height = Field(default=0.0, description="of the ZMP that the planner measures")
    com_noise: Height = Field(
        default=0.0, description="of the CoM that the planner measures; of its velocity 5 / s times as much"
    )
    encoder_noise: Annotated[NonNegative, RADIAN] = Field(default=0.0, description="of the joint encoders")
    gyro_noise: Annotated[NonNegative, RADIAN_PER_SECOND] = Field(default=0.0, description="of the gyroscope")
    accelerometer_noise: Annotated[NonNegative, Unit("m/s^2")] = Field(default=0.0, description="of the accelerometer")
    wrench_noise: Annotated[NonNegative, NEWTON] = Field(default=0.0, description="of the foot force sensors")
    latency: Instant = Field(default=0.0, description="age of the measurement")
    force_estimate: bool = Field(
        default=True,
        description="a lasting external force and the true weight are estimated from what the feet feel, and counted "
        "with",
    )


class Start(Group):
    """Where the robot starts; noises are half ranges drawn from the seed."""

    x: Place = Field(default=0.0, description="world position forward")
    y: Place = Field(default=0.0, description="world position left")
    yaw: Angle = Field(default=0.0, description="heading about the world's z axis")
    position_noise: Annotated[Noise, METRE] = Field(
        default=0.0, description="random offset of the base, soles flat on the ground"
    )
    angle_noise: Annotated[Noise, RADIAN] = Field(
        default=0.0, description="random offset of base and joint angles, soles flat"
    )


class GroundError(Group):
    """A box on the ground that neither planner nor controller knows of, in the frame of the start, x ahead."""

    x: Place = Field(description="middle, forward of the start")
    y: Place = Field(default=0.0, description="middle, to the left")
    length: Annotated[float, Field(gt=0, le=100, allow_inf_nan=False), METRE] = Field(description="forward")
    width: Annotated[float, Field(gt=0, le=100, allow_inf_nan=False), METRE] = Field(
        default=2.0, description="sideways"
    )
    height: Annotated[float, Field(gt=0, le=1, allow_inf_nan=False), METRE] = Field(
        description="of its top over the ground at the start"
    )


class PayloadError(Group):
    """A mass that the robot carries and that neither planner nor controller knows of."""

    mass: Annotated[float, Field(ge=0, le=1000, allow_inf_nan=False), KILOGRAM] = Field(
        default=0.0, description="carried, at the centre of mass of its body"
    )
    body: str | None = Field(default=None, description="body that carries it, null: the torso")


class BeliefErrors(Group):
    """The planner's belief minus the truth."""

    com_height: Annotated[float, Field(ge=-0.4, le=0.4, allow_inf_nan=False), METRE] = Field(
        default=0.0, description="error of the CoM height"
    )
    mass_scale: Annotated[float, Field(ge=0.5, le=2.0, allow_inf_nan=False)] = Field(
        default=1.0, description="believed over true mass [-]"
    )
    link_mass_noise: Annotated[float, Field(ge=0, le=0.5, allow_inf_nan=False)] | None = Field(
        default=None,
        description="half range of the relative error of the mass of every body, each drawn from the seed, null: 0 [-]",
    )
    torso_com: Annotated[tuple[Offset, Offset, Offset], BeforeValidator(as_tuple)] | None = Field(
        default=None, description="error of the centre of mass of the torso's own body, in its frame, null: none"
    )
    payload: PayloadError | None = Field(default=None, description="a mass carried that is not believed in, null: none")
    friction: Annotated[float, Field(ge=-10, le=10, allow_inf_nan=False)] = Field(
        default=0.0, description="error of the friction coefficient [-]"
    )
    ground: Annotated[tuple[GroundError, ...], BeforeValidator(as_tuple)] | None = Field(
        default=None, description="boxes on the ground that are not believed in, null: none"
    )
    ground_noise: Annotated[float, Field(ge=0, le=0.05, allow_inf_nan=False), METRE] | None = Field(
        default=None,
        description="half range by which level ground is truly higher or lower, tile by tile from the seed, null: 0",
    )


class PushSettings(Group):
    """A force on a body, beginning at a time or at a point of the gait."""

    time: Instant | None = Field(default=None, description="begin; or give step, phase and fraction")
    step: Annotated[int, Field(ge=1), WHOLE] | None = Field(default=None, description="footstep, 1 is the first [-]")
    phase: Literal["single", "double"] | None = Field(
        default=None, description="its support phase; double precedes single"
    )
    fraction: Annotated[float, Field(ge=0, le=1)] | None = Field(
        default=None, description="elapsed share of the phase [-]"
    )
    duration: Span = Field(default=0.1, description="how long the force acts")
    force: Force | None = Field(default=None, description="force in the world frame; or give impulse")
    impulse: Impulse | None = Field(
        default=None,
        description="impulse per kilogram of the robot as simulated, with all that it carries",
    )
    direction: Angle | None = Field(
        default=None, description="where the impulse points on the ground, from the world's x axis to the left, null: 0"
    )
    body: str | None = Field(default=None, description="body it acts on, at its centre of mass; null: the torso")
    live: Live = False


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
    time: Instant = Field(default=0.0, description="begin")
    duration: Span | None = Field(default=None, description="how long, null: to the end")


class Rates(Group):
    """Rates of the one integer clock; each must divide the one before."""

    physics: Rate = Field(default=1000, description="simulator steps")
    control: Rate = Field(default=500, description="whole-body controller ticks")
    planner: Rate = Field(default=50, description="plans; 1 / planner.sample_time")


class Scenario(Group):
    """A walk to simulate and the criteria it must meet."""

    name: str = Field(default="scenario", min_length=1, max_length=100, pattern=NAME, description="name")
    robot: str = Field(
        default=DEFAULTS["robot"], description="name of a robot, see `surefoot list`, or the path of a robot file"
    )
    sized_for: str | None = Field(
        default=None,
        description="name of the robot for which lengths, times, forces and the like of this file are written; for "
        "another robot they are scaled to its size, null: they are meant as they are",
    )
    fidelity: Literal["full", "pendulum"] = Field(
        default="full", description="whole body in MuJoCo, or the pendulum alone"
    )
    seed: Annotated[int, Field(ge=0, lt=2**32), WHOLE] = Field(default=0, description="seed of everything random [-]")
    duration: Span | None = Field(default=None, description="simulated time, null: until the gait has ended")
    robot_options: RobotSettings = Field(default=RobotSettings(), description="changes to the robot")
    terrain: Annotated[SerializeAsAny[TerrainSettings], BeforeValidator(_by_its_kind)] = Field(
        default=TerrainSettings(), description="the ground"
    )
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
    commands: Annotated[tuple[CommandSettings, ...], BeforeValidator(as_tuple)] = Field(
        default=(), description="what the walk is told while it goes on"
    )
    faults: Annotated[tuple[Fault, ...], BeforeValidator(as_tuple)] = Field(default=(), description="injected faults")
    rates: Rates = Field(default=Rates(), description="the clock")
    criteria: dict[str, Bound] = Field(default_factory=standing_walk, description="bounds on metrics")
