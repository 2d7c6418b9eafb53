"""A whole gait from one number: its speed, with the length of the legs; for robots that walk with straight legs."""

import math
from dataclasses import dataclass

from surefoot.errors import ParameterError
from surefoot.planner.types import GRAVITY

_WALK_RATIO = 0.89
"""Step length over step rate, over leg length and its time √(l / g) [-].

People keep it at all speeds (Sekiya and Nagasaki, Reproducibility of the walking patterns of normal young adults,
Gait & Posture 1998): 0.0042 m per step and minute, 0.85 for legs of 0.94 m."""

_DOUBLE = 0.24
"""Share of a step in which both feet carry [-]; of people 0.3 when they stroll and 0.2 when they walk fast."""

_HEEL_OFF, _HEEL_STRIKE = 2.2, 0.95
"""Pitch of a foot at toe-off over step length per leg length, and at heel strike over its square [rad]."""

_YAW, _LIST = 0.13, 0.06
"""Turn of the pelvis as a foot lands, and its list over one foot, over step length per leg length [rad].

People turn it by 5 degrees at 1.2 m/s. They list nearly as far; beyond half of that the waist takes more energy than
straighter knees are worth.
"""

_STEADY, _FADING = 0.64, 0.08
"""Step length from which on the pelvis does neither, over the leg length, and over which both fade before it [-].

At 1.4 m/s a foot came late with the first of the shorter steps to a stop, and the sole slapped down with 2.2 body
weights in place of 1.5."""

_MOST_OFF, _MOST_STRIKE = 0.7, 0.6
"""Greatest of both pitches, as far as ankles go at all [rad].

At 0.6 m/s and 0.8 rad at toe-off TALOS misses its CoM height by 16 mm, and GR3 leaves the ground for 2 ms."""

_ROLLING = 1.8
"""Greatest pitch at toe-off over double support in the leg's time √(l / g) [rad].

A heel that leaves the ground faster throws the body: at 1.4 m/s the other foot landed with 2.3 body weights."""

_RISING = 1.7
"""Greatest vertical acceleration of the CoM, whatever the arc of a straight leg asks for [m/s^2]."""

_LONG, _LOWER = 0.53, 0.15
"""Step length beyond which knees are bent more, over the leg length, and by how much lower hips then are [-].

At 1.17 m/s on a ground with a friction of 0.5 it lost its balance without, and at 1.4 m/s it landed with 2.3 body
weights in place of 1.6."""

_FLAT = 0.02
"""Height by which hips are lower over feet that land flat, which leave knees less room, over the leg length [-]."""

_EASY = 0.62
"""Change of the step length that one step makes, over the leg length [-]."""


@dataclass(frozen=True, slots=True)
class SpeedGait:
    """The numbers of a gait that follow from its speed.

    Attributes:
        step_length: from one footstep to the next [m].
        single_support: duration of single support [s].
        double_support: duration of double support [s].
        com_height: of the CoM over the soles, in the middle of double support [m].
        rise: of the CoM from there to the middle of single support [m].
        heel_off: greatest pitch of a foot after its stance [rad].
        heel_strike: greatest pitch of a foot as it lands, toes up [rad].
        pelvis_yaw: turn of the pelvis as a foot lands [rad].
        pelvis_list: drop of the pelvis to the swinging side [rad].
        ramp: steps over which the walk comes to its length, and from it to a stop [-].
    """

    step_length: float
    single_support: float
    double_support: float
    com_height: float
    rise: float
    heel_off: float
    heel_strike: float
    pelvis_yaw: float
    pelvis_list: float
    ramp: int


def speed_gait(
    speed: float,
    leg_length: float,
    com_above_hip: float,
    step_length: float | None = None,
    single_support: float | None = None,
    double_support: float | None = None,
    heel_strike: float | None = None,
) -> SpeedGait:
    """The gait of a speed, with those of its numbers that are given.

    Args:
        speed: of steady walking [m/s].
        leg_length: hip centre to sole, with a straight knee [m].
        com_above_hip: CoM over the hip centres [m].
        step_length: asked for [m].
        single_support: asked for [s].
        double_support: asked for [s].
        heel_strike: asked for [rad].

    Raises:
        ParameterError: length and durations are given, and make another speed.
    """
    length, single, double = _stride(speed, leg_length, step_length, single_support, double_support)
    per_leg, step = abs(length) / leg_length, single + double
    # Both legs straight on flat soles in the middle of double support: feet that roll leave their knees room.
    usual = min(_HEEL_STRIKE * per_leg * per_leg, _MOST_STRIKE)
    strike = usual if heel_strike is None else heel_strike
    hip = leg_length * math.sqrt(max(1.0 - (0.5 * per_leg) ** 2, 0.0))
    hip -= leg_length * (
        _LOWER * max(0.0, per_leg - _LONG) + _FLAT * max(0.0, 1.0 - strike / usual if usual > 0.0 else 0.0)
    )
    swayed = per_leg * min(1.0, max(0.0, (_STEADY - per_leg) / _FADING))
    arc, most = leg_length - hip, 2.0 * _RISING * (step / (2.0 * math.pi)) ** 2
    return SpeedGait(
        step_length=length,
        single_support=single,
        double_support=double,
        com_height=hip + com_above_hip,
        rise=min(arc, most),
        heel_off=min(_HEEL_OFF * per_leg, _MOST_OFF, _ROLLING * double / math.sqrt(leg_length / GRAVITY)),
        heel_strike=strike,
        pelvis_yaw=_YAW * swayed,
        pelvis_list=_LIST * swayed,
        ramp=max(0, math.ceil(per_leg / _EASY) - 1),
    )


def _stride(
    speed: float, leg_length: float, length: float | None, single: float | None, double: float | None
) -> tuple[float, float, float]:
    """Step length [m], single and double support [s] of a speed, see `speed_gait`."""
    step = None if single is None or double is None else single + double
    if length is not None and step is not None and not math.isclose(length, speed * step, rel_tol=_ROUNDED):
        what = f"speed {speed:g} m/s beside steps of {length:g} m in {step:g} s, which is {length / step:g} m/s"
        raise ParameterError(("gait", "speed"), what, "leave out the speed, or one of the others")
    if step is None:
        step = math.sqrt(_WALK_RATIO * leg_length * math.sqrt(leg_length / GRAVITY) / speed)
        if length is not None:
            step = abs(length) / speed
        elif single is not None:
            step = single / (1.0 - _DOUBLE)
        elif double is not None:
            step = double / _DOUBLE
    if single is None:
        single = (1.0 - _DOUBLE) * step if double is None else step - double
    if double is None:
        double = step - single
    for name, left in (("single_support", double), ("double_support", single)):
        if left <= 0.0:
            what = f"speed {speed:g} m/s with steps of {step:g} s, of which {name} takes all"
            raise ParameterError(("gait", name), what, f"use less than {step:g} s")
    return speed * step if length is None else length, single, double


_ROUNDED = 1e-3
"""Share by which given numbers may make another speed, since they are written with few digits [-]."""
