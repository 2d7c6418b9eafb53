"""The gait as the user asks for it: how many steps, how long, how fast, how high."""

import math
from dataclasses import dataclass, fields
from itertools import accumulate, chain

from surefoot.errors import ParameterError
from surefoot.planner.types import Foot, Twist


@dataclass(frozen=True, slots=True)
class Bout:
    """A time of standing and the strides that follow it; the last of them is followed by standing again.

    Attributes:
        stand: rest before the first double support [s].
        strides: in order, at least one.

    Raises:
        ParameterError: the rest is negative or not finite, there is no stride, or one of them is not finite or has a
            width that is not positive.
    """

    stand: float
    strides: tuple[Twist, ...]

    def __post_init__(self) -> None:
        if not (self.stand >= 0.0 and math.isfinite(self.stand)):
            what = f"the standing before a bout is {self.stand:g} s"
            raise ParameterError(("bout", "stand"), what, "it must be at least 0 and finite")
        if not self.strides:
            raise ParameterError(("bout", "strides"), "a bout has no strides", "it must have at least one")
        for stride in set(self.strides):
            for name, value in stride._asdict().items():
                if not math.isfinite(value) or (name == "width" and value <= 0.0):
                    least = " greater than 0" if name == "width" else ""
                    what, right = f"the {name} of a stride is {value}", f"it must be a finite number{least}"
                    raise ParameterError(("stride", name), what, right)


WEIGHT_SHIFT = 2
"""Length of the first double support of a bout, which shifts the weight from rest, in usual double supports [-].

The ZMP rests for the first of them, so that the DCM is consistent when the weight shift begins.
"""

_POSITIVE = ("step_width", "single_support", "double_support", "com_height", "swing_height")
_NOT_NEGATIVE = ("initial_stand", "apex_ss", "apex_ds", "heel_off", "heel_strike", "pelvis_yaw", "pelvis_list", "ramp")


@dataclass(frozen=True, slots=True)
class GaitParameters:
    """Parameters of a walk from standing to standing (the paper's table of parameters, with what it leaves open).

    `steps` counts every step taken. The last step brings its foot beside the other one, so that the robot ends in a
    square stance; the path therefore advances `steps - 1` times by (`step_length`, `lateral_step`). A walk of unequal
    steps, or with stops, is given by its `bouts` (see `planner.steps.commands`), and step_length, lateral_step, turn
    and initial_stand then say nothing.

    Attributes:
        steps: number of steps, 0 stands for ever; with bouts the number of all their strides.
        step_length: distance from one footstep to the next along the heading, negative walks backward (S_L) [m].
        step_width: lateral distance between the two feet in the square stance [m].
        lateral_step: lateral progress of the path per step, positive to the left; diagonal walking (S_w) [m].
        turn: change of heading per step, positive to the left [rad].
        single_support: duration of single support (T_ss) [s].
        double_support: duration of double support (T_ds) [s].
        swing_height: clearance of the swing sole above the higher of lift-off and touchdown [m].
        com_height: CoM height above the support (z_c0) [m].
        initial_stand: rest before the first double support [s].
        first_foot: the foot that swings first.
        apex_ss: rise of the CoM in the middle of single support (A_ss) [m].
        apex_ds: rise of the CoM in the middle of double support (A_ds) [m].
        heel_off: greatest pitch of a foot about its toe edge after its stance, 0 keeps the feet level [rad].
        heel_strike: greatest pitch of a foot about its heel edge as it lands, 0 lands it flat [rad].
        pelvis_yaw: turn of the pelvis as a foot lands, forward on the side of that foot, 0 keeps it along the feet
            [rad].
        pelvis_list: drop of the pelvis to the swinging side in the middle of single support, 0 keeps it level [rad].
        ramp: shorter steps at the begin and at the end of equal steps, whose lengths grow evenly to step_length.
        bouts: the walk stride by stride; empty for equal strides. Feet alternate throughout, across stops too.

    Raises:
        ParameterError: a value is not finite or has the wrong sign, or the bouts have another number of strides.
    """

    steps: int = 5
    step_length: float = 0.2
    step_width: float = 0.2
    lateral_step: float = 0.0
    turn: float = 0.0
    single_support: float = 1.5
    double_support: float = 0.5
    swing_height: float = 0.05
    com_height: float = 1.0
    initial_stand: float = 1.0
    first_foot: Foot = Foot.LEFT
    apex_ss: float = 0.0135
    apex_ds: float = 0.00135
    heel_off: float = 0.0
    heel_strike: float = 0.0
    pelvis_yaw: float = 0.0
    pelvis_list: float = 0.0
    ramp: int = 0
    bouts: tuple[Bout, ...] = ()

    def __post_init__(self) -> None:
        for field in fields(self):
            value = getattr(self, field.name)
            if field.name == "bouts" or 0 < value < math.inf:
                continue
            key, what = ("gait", field.name), f"{field.name} is {value:g}"
            if not math.isfinite(value):
                raise ParameterError(key, what, "it must be a finite number")
            if field.name in _POSITIVE and value <= 0.0:
                raise ParameterError(key, what, "it must be greater than 0")
            if field.name in _NOT_NEGATIVE and value < 0.0:
                raise ParameterError(key, what, "it must not be negative")
        key, what = ("gait", "steps"), f"steps is {self.steps}"
        if self.steps < 0 or self.steps != int(self.steps):
            raise ParameterError(key, what, "it must be a whole number of at least 0")
        strides = sum(len(bout.strides) for bout in self.bouts)
        if self.bouts and strides != self.steps:
            raise ParameterError(key, f"{what}, but the bouts have {strides} strides", "both must be equal")

    @property
    def walk(self) -> tuple[Bout, ...]:
        """The walk stride by stride; () when it only stands."""
        if self.bouts or self.steps == 0:
            return self.bouts
        closing = Twist(width=self.step_width)
        return (Bout(self.initial_stand, (*map(self._stride, range(1, self.steps)), closing)),)

    def _stride(self, number: int) -> Twist:
        """An equal stride, or a shorter one of the ramps at both ends."""
        share = min(number, self.steps - number, self.ramp + 1) / (self.ramp + 1)
        return Twist(share * self.step_length, self.lateral_step, self.turn, self.step_width)

    @property
    def strides(self) -> tuple[Twist, ...]:
        """The strides of all bouts."""
        return tuple(chain.from_iterable(bout.strides for bout in self.walk))

    @property
    def begins(self) -> dict[int, float]:
        """The standing before each bout by the number of its first step [s]."""
        walk = self.walk
        firsts = accumulate((len(bout.strides) for bout in walk), initial=1)
        return {first: bout.stand for first, bout in zip(firsts, walk, strict=False)}

    @property
    def period(self) -> float:
        """Time from one lift-off to the next [s]."""
        return self.single_support + self.double_support

    @property
    def duration(self) -> float:
        """Time from the start to the end of the last double support; of a gait that stands the rest before it [s]."""
        return self.lift_off(self.steps + 1) if self.steps else self.initial_stand

    def lift_off(self, step: int) -> float:
        """Time at which a foot lifts off; of a step after the last one when it would if the walk went on [s].

        Args:
            step: its number, from 1.

        Raises:
            ParameterError: the gait only stands.
        """
        if not self.steps:
            what = f"there is no step {step} of a gait that stands"
            raise ParameterError(("gait", "steps"), what, "it must have steps")
        shift = WEIGHT_SHIFT * self.double_support
        return sum(stand + shift for first, stand in self.begins.items() if first <= step) + (step - 1) * self.period

    def support_before(self, step: int) -> float:
        """Duration of the double support before a step [s]."""
        return self.double_support * (WEIGHT_SHIFT if step in self.begins else 1)

    def step_foot(self, step: int) -> Foot:
        """The foot that step number `step` moves; steps count from 1, number 0 and -1 are the start feet."""
        return self.first_foot if step % 2 == 1 else Foot(self.first_foot).other


def in_samples(duration: float, sample_time: float) -> float:
    """A duration [s] in planner samples [s], a real number; a multiple up to rounding is a whole number."""
    count = duration / sample_time
    whole = round(count)
    return float(whole) if abs(whole * sample_time - duration) <= 1e-9 * max(1.0, duration) else count
