"""The keys of a scenario file: types, units, bounds and defaults.

One frozen model per group. Every key has a default, so a scenario file states only what it changes. What
relates several keys (rates that divide, steps within reach) is checked in ``checks``.
"""

from collections.abc import Callable, Iterator, Mapping
from contextlib import suppress
from copy import copy
from functools import cache
from typing import Annotated, Any, Literal

from pydantic import BaseModel, BeforeValidator, Field, SerializeAsAny, create_model
from pydantic.fields import FieldInfo

from surefoot.parts.plugins import PluginError, Registry
from surefoot.planner.laws.names import PROFILES
from surefoot.scenarios.file.control import ControlSettings, PlantSettings, SeatSettings
from surefoot.scenarios.file.criteria import Bound, standing_walk
from surefoot.scenarios.file.gait import CommandSettings, Gait
from surefoot.scenarios.file.group import (
    WHOLE,
    ControllerSettings,
    Group,
    LawSettings,
    Many,
    RecoverySettings,
    Unfelt,
    as_tuple,
    key,
    keys_of,
)
from surefoot.scenarios.file.names import OneOf, usable
from surefoot.scenarios.file.registries import DEFAULTS, INSTRUMENTS, TERRAIN_KINDS
from surefoot.scenarios.file.search import MOST_RUNS, Bisect
from surefoot.scenarios.file.sensing import MotorSettings, Sensing
from surefoot.scenarios.file.units import METRE, RADIAN, SECOND
from surefoot.scenarios.file.values import (
    LONGEST_RUN,
    NAME,
    Angle,
    FootSize,
    Force,
    Height,
    Impulse,
    Instant,
    Length,
    Live,
    Mass,
    Noise,
    NonNegative,
    Offset,
    Place,
    Rate,
    Requirement,
    Size,
    Span,
    Tilt,
)


class RobotSettings(Group):
    """The changes of the robot."""

    foot_length: FootSize | None = key(None, "sole length, null: the robot's own")
    foot_width: FootSize | None = key(None, "sole width, null: the robot's own")
    payload_mass: Mass = key(0.0, "mass carried")
    payload_body: str | None = key(None, "body that carries it, null: the torso")


class TerrainSettings(Group):
    """The ground."""

    kind: Annotated[str, OneOf("terrain", "kind")] = key(DEFAULTS["terrain"], "shape of the ground")
    riser: Height = key(0.1, "height of a stair, or how much higher or lower a block may be")
    tread: Size = key(0.3, "depth of a stair, or length of a block")
    count: Annotated[int, Field(ge=1, le=1000), WHOLE] = key(5, "number of stairs [-]")
    direction: Literal["up", "down", "up_down"] = key("up", "which way the stairs go")
    start: Length | None = key(
        None,
        "start to the first riser, null: footsteps land in mid-tread, a little behind it if the "
        "foot_length that robot_options gives leaves room; or to the edge of a slope, null: half a step",
    )
    landing: Size | None = key(None, "depth between up and down, null: three treads")
    height_noise: Height = key(
        0.0, "half range by which the true height of each tread or block differs from the planner's belief"
    )
    angle: Angle = key(0.0, "inclination of a slope, negative downhill, or largest pitch and roll of a block")
    friction: Annotated[float, Field(ge=0, le=10)] = key(0.8, "Coulomb coefficient of every surface [-]")


class InstrumentFault(Group):
    """A fault of an instrument's readings for a time."""

    kind: Literal["freeze", "drop", "jump"] = Field(
        description="it says what it said last; it says nothing; each of its numbers is more by size"
    )
    time: Instant = key(0.0, "begin")
    duration: Span | None = key(None, "how long, null: to the end")
    size: Annotated[float, Field(ge=-1e9, le=1e9)] | None = key(None, "of a jump, in the unit of what is read")


class InstrumentSettings(Group):
    """An instrument, which reads the true state into the log; noises and biases are standard deviations."""

    name: Annotated[str, OneOf("instruments", "name")] = Field(description="which one")
    label: Annotated[str, Field(max_length=100, pattern=NAME)] | None = key(
        None, "name of its channel and of its random numbers, null: that of the instrument"
    )
    period: Span | None = key(None, "from one reading to the next, each at the first control tick then, null: a tick")
    faults: Many[InstrumentFault] = key((), "faults of its readings, in time")


class PlannerSettings(LawSettings):
    """The walking planner."""

    profile: Annotated[str, OneOf("planner", "profile")] = key(DEFAULTS["planner"], "formulation of the planner")
    horizon: Annotated[int, Field(ge=2, le=1000), WHOLE] | None = key(
        None, "samples of the horizon, N_p, null: the profile's own [-]"
    )
    control_horizon: Annotated[int, Field(ge=1, le=1000), WHOLE] | None = key(
        None, "moves of the jerk, one per sample, N_c, null: the profile's own blocks [-]"
    )
    sample_time: Annotated[float, Field(ge=1e-5, le=1), SECOND] = key(
        0.02, "sample time of the horizon, and of replanning"
    )
    step_adaptation: Literal["none", "location", "timing", "crossing"] = key(
        "crossing", "what of the next footsteps a push may change: where, when, beyond the stance foot"
    )
    knee: Literal["stretched", "bent", "straight"] = key(
        "stretched",
        "CoM height: the paper's rises, or constant and 0.08 m lower, or one wave of gait.apex_single for each step, "
        "as straight legs carry it",
    )
    rise: Literal["single", "double"] | None = key(
        None, "support phase in which the CoM climbs, null: double on a pendulum, single for legs"
    )
    filter: Literal["none", "kalman", "zmp_only"] | None = key(
        None, "filter of the planner's state, null: kalman when ZMP or CoM are noisy, else none"
    )
    recovery: RecoverySettings | None = key(None, "numbers of its recovery from pushes, null: as they are")
    without: Many[str] = key((), "rules of its recovery that are left out, by their names")


KIND_GROUPS: Mapping[type[BaseModel], tuple[str, Registry[Any]]] = {
    TerrainSettings: ("kind", TERRAIN_KINDS),
    InstrumentSettings: ("name", INSTRUMENTS),
    PlannerSettings: ("profile", PROFILES),
}
"""Groups whose kinds have keys of their own: the key that names the kind, and the kinds."""


def kind_key(model: type[BaseModel]) -> str:
    """The key of a group that names its kind; empty where there are no kinds of it."""
    return KIND_GROUPS[group][0] if (group := _group_of(model)) is not None else ""


def kinds_with(model: type[BaseModel], name: str) -> tuple[str, ...]:
    """The kinds of a group that have a key of this name beside those of all, whatever kind the model is of."""
    group = _group_of(model)
    return () if group is None else tuple(kind for kind, own in own_models(group) if name in own.model_fields)


def _group_of(model: type[BaseModel]) -> type[BaseModel] | None:
    """The group with kinds that a model is of."""
    return next((group for group in KIND_GROUPS if issubclass(model, group)), None)


def model_of(model: type[BaseModel], values: Any) -> type[BaseModel]:
    """The model of a group with plain values, also wrong ones: where there are kinds of it, that of the kind."""
    name, registry = KIND_GROUPS.get(model, ("", None))
    kind = values.get(name) if registry is not None and isinstance(values, dict) else None
    if registry is None or not isinstance(kind, str) or kind == model.model_fields[name].default:
        return model
    with suppress(LookupError, PluginError):
        part = registry[kind]
        own = _of_profile(part) if model is PlannerSettings else part.settings
        return own if isinstance(own, type) and issubclass(own, model) else model
    return model


def _of_profile(profile: Any) -> type[BaseModel]:
    """The group `planner` with the numbers that this profile's law alone reads."""
    own = {name for name in profile.numbers if name not in PlannerSettings.model_fields}
    return _with_numbers(profile.parameters.__class__, frozenset(own)) if own else PlannerSettings


@cache
def _with_numbers(parameters: Callable[[], Any], names: frozenset[str]) -> type[PlannerSettings]:
    keys = keys_of(parameters(), names)
    return create_model("PlannerSettings", __base__=_OfLaw, __module__=__name__, **keys)


class _OfLaw(PlannerSettings):
    """The walking planner, with numbers of one law; another process makes the class anew from the profile's name."""

    def __reduce__(self) -> tuple[Callable[[Any], Any], tuple[dict[str, Any]]]:
        return _planner_settings, (self.model_dump(exclude_unset=True),)


def _planner_settings(values: dict[str, Any]) -> BaseModel:
    return model_of(PlannerSettings, values).model_validate(values)


def own_models(model: type[BaseModel]) -> Iterator[tuple[str, type[BaseModel]]]:
    """The kinds of a group that have keys of their own, each with its model; none of a group without kinds."""
    name, registry = KIND_GROUPS.get(model, ("", None))
    for kind in () if registry is None else usable(registry):
        own = model_of(model, {name: kind})
        if own is not model:
            yield kind, own


def own_keys(model: type[BaseModel]) -> Iterator[tuple[str, FieldInfo]]:
    """The keys that kinds of a group have beside those of all, by name; each is described by its kind or kinds."""
    found: dict[str, list[tuple[str, FieldInfo]]] = {}
    for kind, own in own_models(model):
        for name, field in own.model_fields.items():
            if name not in model.model_fields:
                found.setdefault(name, []).append((f"{kind}: {field.description}", field))
    for name, several in found.items():
        field = copy(several[0][1])
        field.description = "; ".join(text for text, _ in several)
        yield name, field


def _by_its_kind(model: type[BaseModel]) -> Callable[[Any], Any]:
    """Validator of a group by the model of its kind."""

    def validated(values: Any) -> Any:
        own = model_of(model, values)
        return values if own is model else own.model_validate(values)

    return validated


class Start(Group):
    """The place and posture of the robot at the start; noises are half ranges drawn from the seed."""

    x: Place = key(0.0, "world position forward")
    y: Place = key(0.0, "world position left")
    yaw: Angle = key(0.0, "heading about the world's z axis")
    position_noise: Annotated[Noise, METRE] = key(0.0, "random offset of the base, soles flat on the ground")
    angle_noise: Annotated[Noise, RADIAN] = key(0.0, "random offset of base and joint angles, soles flat")


class GroundError(Group):
    """A box on the ground that neither planner nor controller knows of, in the frame of the start, x ahead."""

    x: Place = Field(description="middle, forward of the start")
    y: Place = key(0.0, "middle, to the left")
    length: Annotated[float, Field(gt=0, le=100), METRE] = Field(description="forward")
    width: Annotated[float, Field(gt=0, le=100), METRE] = key(2.0, "sideways")
    height: Annotated[float, Field(gt=0, le=1), METRE] = Field(description="of its top over the ground at the start")
    friction: Annotated[float, Field(ge=0, le=10)] | None = key(None, "Coulomb coefficient, null: the ground's [-]")


class PayloadError(Group):
    """A mass that the robot carries and that neither planner nor controller knows of."""

    mass: Mass = key(0.0, "carried, at the centre of mass of its body")
    body: str | None = key(None, "body that carries it, null: the torso")


class BeliefErrors(Group):
    """The planner's belief minus the truth."""

    com_height: Annotated[float, Field(ge=-0.4, le=0.4), METRE] = key(0.0, "error of the CoM height")
    mass_scale: Annotated[float, Field(ge=0.5, le=2.0)] = key(1.0, "believed over true mass [-]")
    link_mass_noise: Annotated[float, Field(ge=0, le=0.5)] | None = key(
        None, "half range of the relative error of the mass of every body, each drawn from the seed, null: 0 [-]"
    )
    torso_mass: Annotated[float, Field(ge=0.5, le=2.0)] | None = key(
        None, "believed over true mass of the torso's own body, null: 1 [-]"
    )
    torso_com: Annotated[tuple[Offset, Offset, Offset], BeforeValidator(as_tuple)] | None = key(
        None, "error of the centre of mass of the torso's own body, in its frame, null: none"
    )
    payload: PayloadError | None = key(None, "a mass carried that is not believed in, null: none")
    friction: Annotated[float, Field(ge=-10, le=10)] = key(0.0, "error of the friction coefficient [-]")
    ground: Many[GroundError] | None = key(None, "boxes on the ground that are not believed in, null: none")
    ground_noise: Annotated[float, Field(ge=0, le=0.05), METRE] | None = key(
        None, "half range by which level ground is truly higher or lower, tile by tile from the seed, null: 0"
    )
    ground_pitch: Tilt | None = key(None, "angle by which level ground truly rises ahead of the start, null: 0")
    ground_roll: Tilt | None = key(None, "angle by which it truly rises to the left there, null: 0")


class PushSettings(Group):
    """A force on a body, beginning at a time or at a point of the gait."""

    time: Instant | None = key(None, "begin; or give step, phase and fraction")
    step: Annotated[int, Field(ge=1), WHOLE] | None = key(None, "footstep, 1 is the first [-]")
    phase: Literal["single", "double"] | None = key(None, "its support phase; double precedes single")
    fraction: Annotated[float, Field(ge=0, le=1)] | None = key(None, "elapsed share of the phase [-]")
    duration: Span = key(0.1, "how long the force acts")
    force: Force | None = key(None, "force in the world frame; or give impulse")
    impulse: Impulse | None = key(None, "impulse per kilogram of the robot as simulated, with all that it carries")
    direction: Angle | None = key(
        None, "where the impulse points on the ground, from the world's x axis to the left, null: 0"
    )
    elevation: Angle | None = key(None, "how far the impulse points above the ground, null: 0")
    body: str | None = key(None, "body it acts on, at its centre of mass; null: the torso")
    live: Live = False


class PendulumSettings(Group):
    """The plant of fidelity pendulum."""

    plant: Literal["pendulum", "cart_table"] = key(
        "pendulum", "the true pendulum, or the paper's cart-table that does any jerk and cannot fall"
    )
    feedback: NonNegative = key(3.0, "gain of the pendulum's ZMP on its true DCM's error, the low level's part [-]")


class Fault(Group):
    """A fault injected for negative controls."""

    kind: Literal["torque_loss", "planner_freeze", "state_nan", "qp_failure"] = Field(
        description="zero torque; plan not updated; NaN in the measured state; QP solver reports failure"
    )
    time: Instant = key(0.0, "begin")
    duration: Span | None = key(None, "how long, null: to the end")


class Rates(Group):
    """Rates of the one integer clock; each must divide the one before."""

    physics: Rate = key(1000, "simulator steps")
    control: Rate = key(500, "whole-body controller ticks")
    planner: Rate = key(50, "plans; 1 / planner.sample_time")


class LogSettings(Group):
    """The part of a run that its log holds."""

    keep: Annotated[float, Field(ge=1, le=LONGEST_RUN), SECOND] | None = key(
        None, "a flight recorder: at least the last so much of the run, and at most twice that, null: all of it"
    )
    rate: Rate | None = key(
        None, "messages in a second that a channel has at most that no metric and no health check reads, null: all"
    )


_OF_A_BODY, _OF_ITS_CONTROLLER = Unfelt("pendulum"), Unfelt("pendulum", "seat")


class Scenario(Group):
    """A walk to simulate and the criteria it must meet."""

    # Defaults of groups are constructed and not validated, so that no validator is built before a file is read.

    name: str = Field(default="scenario", min_length=1, max_length=100, pattern=NAME, description="name")
    robot: str = key(DEFAULTS["robot"], "name of a robot, see `surefoot list`, or the path of a robot file")
    sized_for: str | None = key(
        None,
        "name of the robot for which lengths, times, forces and the like of this file are written; for "
        "another robot they are scaled to its size, null: they are meant as they are",
    )
    fidelity: Literal["full", "pendulum"] = key("full", "whole body in MuJoCo, or the pendulum alone")
    seed: Annotated[int, Field(ge=0, lt=2**32), WHOLE] = key(0, "seed of everything random [-]")
    duration: Span | None = key(None, "simulated time, null: until the gait has ended")
    robot_options: RobotSettings = key(RobotSettings.model_construct(), "changes to the robot")
    terrain: Annotated[SerializeAsAny[TerrainSettings], BeforeValidator(_by_its_kind(TerrainSettings))] = key(
        TerrainSettings.model_construct(), "the ground"
    )
    gait: Gait = key(Gait.model_construct(), "the walk")
    planner: Annotated[SerializeAsAny[PlannerSettings], BeforeValidator(_by_its_kind(PlannerSettings))] = key(
        PlannerSettings.model_construct(), "the planner"
    )
    sensing: Sensing = key(Sensing.model_construct(), "the sensors")
    instruments: Annotated[
        Many[Annotated[SerializeAsAny[InstrumentSettings], BeforeValidator(_by_its_kind(InstrumentSettings))]],
        _OF_A_BODY,
    ] = key((), "what reads the true state into the log beside all else")
    start: Start = key(Start.model_construct(), "the start pose")
    errors: BeliefErrors = key(BeliefErrors.model_construct(), "the planner's belief minus the truth")
    motors: Annotated[MotorSettings | None, _OF_A_BODY] = key(
        None, "what motors do beside what is commanded, null: nothing"
    )
    plant: Annotated[PlantSettings | None, _OF_A_BODY] = key(None, "what moves the robot, null: the simulated world")
    control: Annotated[ControlSettings | None, _OF_ITS_CONTROLLER] = key(
        None, "what the joints are given, null: torques, each control tick"
    )
    wbc: Annotated[ControllerSettings | None, _OF_ITS_CONTROLLER] = key(
        None, "the whole-body controller, null: as it is"
    )
    controller: SeatSettings | None = key(
        None, "what has the seat of planner and whole-body controller, null: they have it"
    )
    log: LogSettings | None = key(None, "how much of the run its log holds, null: all of it")
    pendulum: PendulumSettings = key(PendulumSettings.model_construct(), "the plant of fidelity pendulum")
    pushes: Many[PushSettings] = key((), "disturbances")
    commands: Many[CommandSettings] = key((), "commands to the walk while it goes on")
    faults: Many[Fault] = key((), "injected faults")
    rates: Rates = key(Rates.model_construct(), "the clock")
    seeds: Annotated[int, Field(ge=1, le=MOST_RUNS), WHOLE] | None = key(
        None,
        "runs of `surefoot check` at most, with this seed and those after it, null: as its baseline says [-]",
    )
    margins: dict[Annotated[str, Field(pattern=NAME)], Bisect] | None = key(
        None, "thresholds that `surefoot check` searches with each seed, by a name of one's own, null: none"
    )
    criteria: dict[str, Bound] = Field(default_factory=standing_walk, description="bounds on metrics")
    requirements: Many[Requirement] | None = key(
        None, "names of what the walk shows to be kept, such as REQ-7, for reports of checks, null: none"
    )

    @property
    def walker(self) -> str:
        """Kind of what walks: full, pendulum, or seat, of a robot whose controller is none of Surefoot's own."""
        return self.fidelity if self.controller is None else "seat"

    @property
    def straightens(self) -> bool:
        """True if a task straightens knees unless the scenario says otherwise: by a speed, on legs not to be bent.

        A task that straightens knees which are to be bent works against the plan.
        """
        return self.gait.speed is not None and self.walker == "full" and self.planner.knee != "bent"

    @property
    def left_out(self) -> tuple[str, ...]:
        """Criteria that are not asked of what has the seat."""
        return () if self.controller is None else self.controller.left_out
