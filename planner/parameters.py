"""Parameters of the planner itself, apart from the gait."""

import math
from dataclasses import dataclass, field, replace
from enum import Enum

import numpy as np

from surefoot.errors import ParameterError
from surefoot.planner.model.jerk import BLOCK_STARTS
from surefoot.planner.model.leg_chain import LegChain
from surefoot.similarity import REFERENCE_SIZE, Similarity, quantity
from surefoot.tunable import check, number, positive

SOLVERS = ("daqp", "piqp")
"""The solvers of qpsolvers that are tried, in this order.

DAQP, a dual active-set method, is exact and the fastest. A second solver of another kind must agree on what it calls
infeasible. That one must be fast, since profile `paper` has thousands of such ticks. PIQP, a proximal interior-point
method (BSD-2), said so in all 245 of them that were recorded, in 0.5 ms at most, missed no optimum, and with the
tolerances of `planner.laws.qp` meets DAQP's cost to 1e-10 (its jerk to 4e-4 m/s^3 where the cost is flat, else to
1e-5). ProxQP missed 12 of 170 optima; Clarabel takes ten times as long.
"""


@dataclass(frozen=True, slots=True)
class GroundSearch:
    """A search in two stages: gently, since the ground is hardly below; then in haste, since waiting costs balance.

    Raises:
        ParameterError: a number is negative, an acceleration is zero, or one that must be finite is not.
    """

    touchdown_speed: float = number(0.01, "m/s", "downward speed at touchdown")
    speed: float = number(0.15, "m/s", "greatest downward speed after it")
    acceleration: float = positive(
        0.5, "m/s^2", "at which that speed is gained; a jump would shake the ZMP of the stance foot"
    )
    hurry_after: float = number(
        math.inf, "s", "time from the touchdown after which the foot hurries, infinite for never", endless=True
    )
    hurry_speed: float = number(0.5, "m/s", "greatest downward speed then")
    hurry_acceleration: float = positive(16.0, "m/s^2", "at which that is gained")
    unsure_speed: float = number(
        36.0, "1/s", "how much faster the touchdown is for each metre by which the ground's height is unsure"
    )
    unsure_acceleration: float = positive(
        5100.0, "1/s^2", "how much greater its acceleration is for each metre of that"
    )
    unsure_aim: float = number(
        1.5, "-", "how far below the ground a footstep is aimed, in standard deviations of its height"
    )
    most_unsure: float = number(2e-3, "m", "deviation of the height beyond which nothing changes any more")
    most_astray: float = number(
        6e-3, "m", "by which feet are believed more over the map, or under it, than a step before (see `astray`)"
    )

    def __post_init__(self) -> None:
        check(self, "parameters", "search", of="the ground search")

    def for_deviation(self, deviation: float, over: float = 0.0) -> tuple["GroundSearch", float]:
        """The search for ground of unsure height, and how far below it the footstep is to be aimed [m].

        A foot that is lower than it is believed waits for nothing. One that is higher waits the longer, the more gently
        it goes on, and the DCM does not wait.

        Args:
            deviation: standard deviation of the sole's height over the stance foot [m].
            over: how high feet are believed over the map, and the ground too low (see `astray`) [m].
        """
        if deviation == 0.0:
            return self, 0.0
        least = min(deviation, self.most_unsure)
        speed = self.touchdown_speed + self.unsure_speed * least
        faster = replace(
            self,
            touchdown_speed=speed,
            speed=max(self.speed, speed),
            acceleration=self.acceleration + self.unsure_acceleration * least,
        )
        return faster, self.unsure_aim * least - over

    def astray(self, before: float, over: float) -> float:
        """Height at which the feet are believed over the map, once one more of them stands [m].

        Height goes astray little by little, and is followed however far. A foot that is off by much stands on a step of
        the ground. That counts no more than height goes astray in a step.

        Args:
            before: the same before [m].
            over: how high that foot is believed over the map [m].
        """
        return before + min(max(over - before, -self.most_astray), self.most_astray)

    def motion(self, since: float) -> tuple[float, float, float]:
        """Way down [m], downward speed [m/s] and acceleration [m/s^2], `since` the touchdown [s]."""
        gentle = _gaining(self.touchdown_speed, self.acceleration, self.speed, min(since, self.hurry_after))
        if since < self.hurry_after:
            return gentle
        way, speed, bend = _gaining(gentle[1], self.hurry_acceleration, self.hurry_speed, since - self.hurry_after)
        return gentle[0] + way, speed, bend


def _gaining(speed: float, bend: float, top: float, since: float) -> tuple[float, float, float]:
    """Way, speed and acceleration of a motion that gains speed up to a top."""
    top = max(speed, top)
    gaining = (top - speed) / bend
    way = speed * since + 0.5 * bend * min(since, gaining) ** 2
    if since < gaining:
        return way, speed + bend * since, bend
    return way + (top - speed) * (since - gaining), top, 0.0


class StepAdaptation(Enum):
    """The changes that a disturbance may make to the footsteps."""

    NONE = "none"
    """No changes."""
    LOCATION = "location"
    """The places of the next ones."""
    TIMING = "timing"
    """Places and times."""
    CROSSING = "crossing"
    """Places and times, and a foot may land beyond its stance foot."""

    @property
    def places(self) -> bool:
        """True if places may change."""
        return self is not StepAdaptation.NONE

    @property
    def timing(self) -> bool:
        """True if times may change."""
        return self in (StepAdaptation.TIMING, StepAdaptation.CROSSING)

    @property
    def crossing(self) -> bool:
        """True if a foot may land beyond its stance foot."""
        return self is StepAdaptation.CROSSING


@dataclass(frozen=True, slots=True)
class LegInertia:
    """The legs' inertia in the pendulum (see `planner.references.leg_offset`); none by default.

    Attributes:
        mass_ratio: μ, mass over the total mass of one leg reduced to a point mass at its sole [-].
        chain: the legs with their links, for the ZMP offset of their motion; None leaves it out.

    Raises:
        ParameterError: the mass is negative or no number, or both legs would outweigh the body.
    """

    mass_ratio: float = quantity(0.0, "-")
    chain: LegChain | None = None

    def __post_init__(self) -> None:
        if not 0.0 <= self.mass_ratio < 0.5:
            what = f"the mass ratio of a leg is {self.mass_ratio:g}"
            raise ParameterError(("parameters", "leg", "mass_ratio"), what, "it must be within 0 to 0.5")


_TIME_CHANGES = (*np.arange(-0.6, -0.2, 0.1), *np.arange(-0.24, 0.0, 0.04), -0.02, 0.02, *np.arange(0.04, 0.21, 0.04))
"""Changes of a phase, fine where they are small since a swing's reach grows fast there [s]."""


@dataclass(frozen=True, slots=True)
class RecoveryParameters:
    """Every number of step adjustment, leg reach, capture margin and height transition, for the reference robot.

    Each is a key ``planner.recovery.*`` of a scenario, described as here. Those with a unit beside their default follow
    the robot's size. The campaign ``recovery-numbers`` measures what each moves when it is halved or doubled.
    docs/recovery-results.md reports it, with the tests that notice those which move no threshold.
    """

    second_weight: float = positive(
        1.0, "1/m^2", "cost of a squared shift of the second step; the other weights count against it"
    )
    shift_weight: float = positive(
        0.02,
        "1/m^2",
        "cost of a squared shift of the next footstep; small, since that step is the means",
    )
    time_weight: float = positive(
        0.38,
        "-",
        "cost of a squared change of the times left, as shares of a step; small changes are cheap",
    )
    stretch_weight: float = positive(
        1.0,
        "1/m^2",
        "cost of the squared way by which the stance hip is out of its leg's reach at landing",
    )
    swing_weight: float = positive(
        40.0,
        "1/m^2",
        "cost of a squared way that the hips cannot swing the foot in time; nearly a constraint",
    )
    cross_factor: float = positive(
        3.0,
        "-",
        "factor, before squaring, of a second shift that is to cross: legs cross less than they spread",
    )
    least_saving: float = positive(
        0.001, "-", "cost that other times must save; between equal ones the plan would go to and fro"
    )
    cop_share: float = positive(
        0.8,
        "-",
        "share of the ZMP box on which an adjusted step counts; the rest corrects what comes later",
    )
    landing_share: float = positive(
        0.5, "-", "DCM error at landing, as a share of the CoP's box, that an adjusted step may leave"
    )
    landing_spare: float = positive(0.03, "m", "the same for long boxes: all of the box but this")
    tolerance: float = positive(
        0.02,
        "m",
        "DCM error beyond what the CoP holds at which a step is adjusted, or in a stand its foot chosen",
    )
    unheld_share: float = positive(
        0.5, "-", "the same of feet whose CoP cannot be moved at will, as a share of the ZMP box"
    )
    stand_share: float = positive(0.85, "-", "share of the ZMP box of a stand that holds a DCM error without any step")
    again_cost: float = positive(
        1.75, "-", "cost of its next step above which the foot that has just landed does not step again"
    )
    time_changes: tuple[float, ...] = number(
        tuple(map(float, _TIME_CHANGES)),
        "s",
        "changes of the times left that are tried, close where a swing's reach grows fast",
        least=-math.inf,
    )
    least_double: float = positive(
        0.02,
        "s",
        "least time to which the rest of a double support is shortened; the foot behind bears next to nothing then",
    )
    least_single: float = positive(
        0.10, "s", "least time to which the rest of a single support is shortened; a foot has to lift and land in it"
    )
    apart: float = positive(
        0.03, "m", "distance of a foot from its place beside the other at which it is brought back there"
    )
    calm: float = positive(
        0.005,
        "m",
        "DCM error below which a standing robot brings it back; a step at more would be a second push",
    )
    margin_times: tuple[float, ...] = number(
        (0.0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.7, 1.0),
        "-",
        "shares between the shortest and longest single support at which the margin is evaluated",
    )
    longer: float = positive(0.2, "s", "by how much the margin lets a single support last longer")
    most_steps: int = positive(
        5, "-", "steps that the margin counts with; the sum over more of them has converged", most=1000
    )
    fall_margin: float = positive(0.15, "m", "how far outside the capture margin the DCM is of a robot that will fall")
    fall_plans: int = positive(
        3, "-", "plans on end with the DCM so far outside that tell a fall; a touchdown makes up for fewer", most=1000
    )
    regained_plans: int = positive(
        5, "-", "plans on end with margin that take it back; fewer come in the middle of falls", most=1000
    )
    sole_gap: float = positive(0.01, "m", "least distance of soles side by side")
    across: float = positive(0.12, "m", "how far beyond its stance foot a foot may land, with the thighs apart")
    clear: float = positive(0.02, "m", "gap of soles one ahead of the other from which on the foot may cross")
    spanned: float = positive(
        0.75,
        "-",
        "share of what both legs span at a height that a step makes use of: the body is not midway",
    )
    parallel: float = positive(
        0.02,
        "rad",
        "angle up to which feet count as parallel, and the room of a footstep as the same in both frames",
    )
    lifting: float = positive(
        5.0,
        "m/s^2",
        "vertical acceleration of the CoM in a height transition; like gravity the same for all sizes",
        sized=False,
    )
    same_height: float = positive(0.005, "m", "change of the wanted lowering that begins no height transition")
    offset_ticks: int = positive(
        5, "-", "plans for which an offset of the legs serves; making it costs more than the rest of one", most=1000
    )
    same_swing: float = positive(
        0.005, "m", "shift of a footstep for which it serves: it moves the DCM by less than a millimetre"
    )

    def __post_init__(self) -> None:
        check(self, "planner", "recovery")

    @property
    def longest_cut(self) -> float:
        """The greatest cut among the changes of a time [s]. It is infinite without any cut."""
        return max(-min(self.time_changes, default=0.0), 0.0) or math.inf


@dataclass(frozen=True, slots=True)
class PlannerParameters:
    """Parameters of the walking planner; the defaults are the measured robust formulation, for the reference robot.

    Those of a robot of another size are these, scaled by their units (see `surefoot.similarity`).

    Attributes:
        moves: first sample of each block of constant jerk (see `planner.model.jerk`).
        leg: inertia of the legs; the default is the paper's point mass without any.
        step_adaptation: what a disturbance may change about the footsteps.
        toes_bear: whether ankles bear the robot with its weight on the toe edge of one foot, so that heels leave early.
        search: speed of the swing foot at the planned touchdown, and how it goes on while it feels no ground.
        recovery: numbers of step adjustment, capture margin and what belongs to them.
        solvers: QP solvers of qpsolvers, in the order in which they are tried (see `planner.laws.law` for the choice).
        size: of the robot, for what is no parameter: the planner's constants are the reference robot's.

    Raises:
        ParameterError: a number is not positive, or not finite where it must be.
    """

    sample_time: float = positive(0.02, "s", "T_s")
    horizon: int = positive(50, "-", "samples over which the jerk is planned (N_p)")
    preview: int = positive(
        100,
        "-",
        "samples beyond the horizon in which known footsteps still shape the terminal DCM bound and ω",
    )
    moves: tuple[int, ...] = BLOCK_STARTS
    jerk_limit: float = positive(60.0, "m/s^3", "bound of the CoM jerk per axis")
    jerk_rate_limit: float = positive(
        math.inf,
        "m/s^3",
        "bound of its change from one block to the next, per sample; infinite for none",
        endless=True,
    )
    jerk_weight: float = number(1e-6, "s^6", "cost of a squared move, against 1 for a squared ZMP error")
    terminal_weight: float = number(
        32.0,
        "-",
        "cost of the squared DCM error at the end of the horizon; the cost-to-go of the best linear DCM feedback is "
        "2 / (ω T_s), 32 at 1 m",
    )
    step_weight: float = positive(30.0, "-", "cost of a squared footstep shift; smaller ones shorten the nominal steps")
    zmp_slack: tuple[float, float] = number((1e3, 30.0), "-, m", "quadratic and linear cost of leaving the ZMP box")
    terminal_slack: tuple[float, float] = number(
        (1e3, 10.0), "-, m", "quadratic and linear cost of leaving the terminal DCM bound"
    )
    foot_margin: float = positive(0.9, "-", "share of the foot in which the ZMP must stay (the paper's 90 %)")
    cop_room: tuple[float, float] = number(
        (math.inf, math.inf),
        "m",
        "how far from the sole's centre, forward and sideways, the ankles' torques let the CoP go",
        endless=True,
    )
    toes_bear: bool = True
    cop_authority: tuple[float, float] = number(
        (math.inf, math.inf),
        "m",
        "how far the CoP of one foot can be moved against a disturbance, forward and sideways; feet that stand on an "
        "edge have none sideways, and a step catches what other feet would hold",
        endless=True,
    )
    terminal_margin: float = positive(0.8, "-", "share of the box's half size that bounds the terminal DCM")
    leg: LegInertia = LegInertia()
    step_adaptation: StepAdaptation = StepAdaptation.CROSSING
    reach_length: float = positive(0.4, "m", "largest distance of a footstep ahead of or behind the stance foot")
    reach_width: tuple[float, float] = number(
        (0.08, 0.4), "m", "smallest and largest lateral distance of a footstep from the stance foot"
    )
    compliance_margin: float = number(0.05, "m", "change of a footstep that the paper's step law does not ask for")
    swing_speed: float = positive(
        3.0,
        "m/s",
        "fastest mean speed of the swing foot to a shifted footstep, where the legs are not known",
    )
    freeze_time: float = number(0.08, "s", "time before touchdown from which the footstep is fixed")
    freeze_catching: float = number(
        0.04,
        "s",
        "that time of a step that catches the body, since until then the DCM may go on elsewhere; not on faces that "
        "were chosen",
    )
    late_touchdown: float = number(0.3, "s", "longest wait of the phase clock for a touchdown")
    apex_share: float = positive(
        0.5,
        "-",
        "share of single support after which the swing sole is highest; a late apex keeps the sole high while the leg "
        "is stretched furthest, shortly before touchdown",
    )
    touchdown_lead: float = number(
        0.02, "s", "the swing ends this long before single support does, so that the foot is felt in time"
    )
    search: GroundSearch = field(default_factory=GroundSearch)
    recovery: RecoveryParameters = RecoveryParameters()
    solvers: tuple[str, str] = SOLVERS
    size: Similarity = REFERENCE_SIZE

    def __post_init__(self) -> None:
        check(self, "parameters", of="the planner")
