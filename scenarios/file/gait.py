"""The keys of the walk that is asked for, before it begins and while it goes on."""

from typing import Annotated, Literal

from pydantic import Field

from surefoot.scenarios.file.group import WHOLE, Group, Many, key
from surefoot.scenarios.file.units import RADIAN, Unit
from surefoot.scenarios.file.values import (
    Angle,
    Apex,
    Height,
    Instant,
    Length,
    Live,
    Place,
    Size,
    Support,
    Turns,
    Velocity,
    YawRate,
)


class VelocitySettings(Group):
    """A velocity command, in force from its time until the next one; all zero is standing."""

    time: Instant = Field(description="from when on")
    v_x: Velocity = key(0.0, "forward velocity of the path")
    v_y: Velocity = key(0.0, "velocity to the left")
    yaw_rate: YawRate = key(0.0, "rate of its heading, left positive")


class FootstepSettings(Group):
    """A footstep, in the frame between the start feet, x along their heading."""

    foot: Literal["left", "right"] = Field(description="foot that steps; they must take turns")
    x: Place = Field(description="sole centre, forward")
    y: Place = Field(description="sole centre, to the left")
    yaw: Turns = key(0.0, "heading of the sole, whole turns counted")


class PlaceSettings(Group):
    """A place to go to, with the heading there."""

    x: Place = Field(description="middle of the stance, forward")
    y: Place = Field(description="middle of the stance, to the left")
    yaw: Turns = key(0.0, "heading")


class CommandSettings(Group):
    """The commands to the walk while it goes on; the planner does not know of them before."""

    time: Instant = Field(description="when")
    v_x: Velocity | None = key(None, "forward velocity from then on, null: 0, or as it was if no velocity is given")
    v_y: Velocity | None = key(None, "velocity to the left, null: 0, or as it was if no velocity is given")
    yaw_rate: YawRate | None = key(None, "rate of the heading, null: 0, or as it was if no velocity is given")
    march: bool | None = key(None, "steps in place where that velocity is zero, null: it stands")
    place: PlaceSettings | None = key(None, "where to go, in the world frame, in place of a velocity")
    single_support: Support | None = key(None, "duration from then on, null: as it was")
    double_support: Support | None = key(None, "duration from then on, null: as it was")
    swing_height: Apex | None = key(None, "apex of the swing foot from then on, null: as it was")
    live: Live = False

    def superseded_by(self, other: "CommandSettings") -> set[str]:
        """Keys of this one that a later one leaves without effect, if nothing comes between them."""
        given, others = ({name for name, value in one if value is not None} for one in (self, other))
        leads = _LEADING & given if _LEADING & others else set()
        return leads | given & others - _LEADING - {"time", "live"}


_LEADING = {"v_x", "v_y", "yaw_rate", "march", "place"}
"""Keys of a command that say where to walk, each of which replaces all."""


class Gait(Group):
    """The walk that is asked for; defaults are the paper's table."""

    steps: Annotated[int, Field(ge=0, le=100_000), WHOLE] = key(5, "footsteps to take [-]")
    step_length: Length = key(
        0.2,
        "forward distance between successive footsteps, and at most that of a walk to a place; on stairs, "
        "unless given, terrain.tread",
    )
    step_width: Size = key(0.2, "lateral distance between the feet's centres")
    lateral_step: Length = key(0.0, "lateral progress of each footstep, left positive")
    turn: Angle = key(0.0, "heading change of each footstep, left positive")
    single_support: Support = key(1.5, "duration of a single support")
    double_support: Support = key(0.5, "duration of a double support")
    swing_height: Apex = key(0.05, "apex of the swing foot above the ground")
    com_height: Size = key(1.0, "CoM height above the soles")
    initial_stand: Instant = key(1.0, "standing before the first weight shift")
    apex_single: Height = key(0.0135, "apex of the CoM rise in single support, A_ss of the paper")
    apex_double: Height = key(0.00135, "apex of the CoM rise in double support, A_ds of the paper")
    velocity: Many[VelocitySettings] = key(
        (), "velocity commands over time, in place of equal steps; the last one must stop"
    )
    footsteps: Many[FootstepSettings] = key((), "every footstep, in place of equal steps")
    waypoints: Many[PlaceSettings] = key(
        (),
        "places to go to one after another and to stand at the last one, with strides of at most "
        "step_length, in the frame between the start feet; in place of equal steps",
    )
    heel_off: Annotated[float, Field(ge=0, le=1.0), RADIAN] = key(
        0.0, "greatest pitch of a foot about its toes after its stance, 0: feet stay level"
    )
    heel_strike: Annotated[float, Field(ge=0, le=0.6), RADIAN] = key(
        0.0, "greatest pitch of a foot about its heel as it lands, toes up, 0: feet land flat"
    )
    pelvis_yaw: Annotated[float, Field(ge=0, le=0.3), RADIAN] = key(
        0.0, "turn of the pelvis as a foot lands, forward on the side of that foot, 0: it stays along the feet"
    )
    pelvis_list: Annotated[float, Field(ge=0, le=0.2), RADIAN] = key(
        0.0, "drop of the pelvis to the side of the swing foot, greatest in mid-swing, 0: it stays level"
    )
    speed: Annotated[float, Field(gt=0, le=5), Unit("m/s")] | None = key(
        None,
        "speed of steady walking ahead, of which the length and durations of the steps, CoM height, roll of the feet, "
        "sway of the pelvis, planner.knee and two weights of wbc follow that are not given, null: they are as they are",
    )
    ramp: Annotated[int, Field(ge=0, le=20), WHOLE] = key(
        0, "shorter steps at the begin and at the end of equal steps, whose lengths grow evenly to step_length [-]"
    )
