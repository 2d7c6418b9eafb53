"""Parameters of the planner itself, apart from the gait."""

import math
from dataclasses import dataclass, field, fields, replace
from enum import Enum

import numpy as np

from surefoot.errors import ParameterError
from surefoot.planner.model.jerk import BLOCK_STARTS
from surefoot.planner.model.leg_chain import LegChain
from surefoot.similarity import REFERENCE_SIZE, Similarity, quantity

SOLVERS = ("daqp", "piqp")
"""The solvers of qpsolvers that are tried, in this order.

DAQP, a dual active-set method, is exact and the fastest. What it calls infeasible is asked of a second one of another
kind, which must agree and lose no time: profile `paper` has such ticks in thousands. PIQP, a proximal interior-point
method (BSD-2), said so in all 245 of them that were recorded, in 0.5 ms at most, missed no optimum, and with the
tolerances of `planner.laws.qp` meets DAQP's cost to 1e-10 (its jerk to 4e-4 m/s^3 where the cost is flat, else to
1e-5). ProxQP missed 12 of 170 optima; Clarabel takes ten times as long.
"""


@dataclass(frozen=True, slots=True)
class GroundSearch:
    """A search in two stages: gently, since the ground is hardly below; then in haste, since waiting costs balance.

    Attributes:
        touchdown_speed: downward speed at touchdown [m/s].
        speed: greatest downward speed after it [m/s].
        acceleration: at which that speed is gained; a jump would shake the ZMP of the stance foot [m/s^2].
        hurry_after: time from the touchdown after which the foot hurries, infinite for never [s].
        hurry_speed: greatest downward speed then [m/s].
        hurry_acceleration: at which that is gained [m/s^2].
        unsure_speed: how much faster the touchdown is for each metre by which the ground's height is unsure [1/s].
        unsure_acceleration: how much greater its acceleration is for each metre of that [1/s^2].
        unsure_aim: how far below the ground a footstep is aimed, in standard deviations of its height [-].
        most_unsure: deviation of the height beyond which nothing changes any more [m].
        most_astray: by which feet are believed more over the map, or under it, than a step before (see `astray`) [m].

    Raises:
        ParameterError: a number is negative, an acceleration is zero, or one that must be finite is not.
    """

    touchdown_speed: float = quantity(0.01, "m/s")
    speed: float = quantity(0.15, "m/s")
    acceleration: float = quantity(0.5, "m/s^2")
    hurry_after: float = quantity(math.inf, "s")
    hurry_speed: float = quantity(0.5, "m/s")
    hurry_acceleration: float = quantity(16.0, "m/s^2")
    unsure_speed: float = quantity(36.0, "1/s")
    unsure_acceleration: float = quantity(5100.0, "1/s^2")
    unsure_aim: float = quantity(1.5, "-")
    most_unsure: float = quantity(2e-3, "m")
    most_astray: float = quantity(6e-3, "m")

    def __post_init__(self) -> None:
        for entry in fields(self):
            value = getattr(self, entry.name)
            key, what = ("parameters", "search", entry.name), f"{entry.name} of the ground search is {value:g}"
            least = "greater than 0" if entry.name.endswith("acceleration") else "at least 0"
            if not value >= 0.0 or (value == 0.0 and least == "greater than 0"):
                raise ParameterError(key, what, f"it must be {least}")
            if not math.isfinite(value) and entry.name != "hurry_after":
                raise ParameterError(key, what, "it must be finite")

    def for_deviation(self, deviation: float, over: float = 0.0) -> tuple["GroundSearch", float]:
        """The search for ground of unsure height, and how far below it the footstep is to be aimed [m].

        A foot that is lower than it is believed waits for nothing; one that is higher waits the longer the more gently
        it goes on, while the DCM does not wait.

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
    the robot's size. What each moves when it is halved or doubled is measured by the campaign ``recovery-numbers`` and
    reported in docs/recovery-results.md, with the tests that notice those which move no threshold.

    Attributes:
        second_weight: cost of a squared shift of the second step; the other weights count against it [1/m^2].
        shift_weight: cost of a squared shift of the next footstep; small, since that step is the means [1/m^2].
        time_weight: cost of a squared change of the times left, as shares of a step; small changes are cheap [-].
        stretch_weight: cost of the squared way by which the stance hip is out of its leg's reach at landing [1/m^2].
        swing_weight: cost of a squared way that the hips cannot swing the foot in time; nearly a constraint [1/m^2].
        cross_factor: factor, before squaring, of a second shift that is to cross: legs cross less than they spread [-].
        least_saving: cost that other times must save; between equal ones the plan would go to and fro [-].
        cop_share: share of the ZMP box on which an adjusted step counts; the rest corrects what comes later [-].
        landing_share: DCM error at landing, as a share of the CoP's box, that an adjusted step may leave [-].
        landing_spare: the same for long boxes: all of the box but this [m].
        tolerance: DCM error beyond what the CoP holds at which a step is adjusted, or in a stand its foot chosen [m].
        unheld_share: the same of feet whose CoP cannot be moved at will, as a share of the ZMP box [-].
        stand_share: share of the ZMP box of a stand that holds a DCM error without any step [-].
        again_cost: cost of its next step above which the foot that has just landed does not step again [-].
        time_changes: changes of the times left that are tried, close where a swing's reach grows fast [s].
        least_double: time left of a double support below which none is cut; the load has to go over [s].
        least_single: time left of a single support below which none is cut; a foot has to lift and land [s].
        apart: distance of a foot from its place beside the other at which it is brought back there [m].
        calm: DCM error below which a standing robot brings it back; a step at more would be a second push [m].
        margin_times: shares between the shortest and longest single support at which the margin is evaluated [-].
        longer: by how much the margin lets a single support last longer [s].
        most_steps: steps that the margin counts with; the sum over more of them has converged [-].
        fall_margin: how far outside the capture margin the DCM is of a robot that will fall [m].
        fall_plans: plans on end with the DCM so far outside that tell a fall; a touchdown makes up for fewer [-].
        regained_plans: plans on end with margin that take it back; fewer come in the middle of falls [-].
        sole_gap: least distance of soles side by side [m].
        across: how far beyond its stance foot a foot may land, with the thighs apart [m].
        clear: gap of soles one ahead of the other from which on the foot may cross [m].
        spanned: share of what both legs span at a height that a step makes use of: the body is not midway [-].
        parallel: angle up to which feet count as parallel, and the room of a footstep as the same in both frames [rad].
        lifting: vertical acceleration of the CoM in a height transition; like gravity the same for all sizes [m/s^2].
        same_height: change of the wanted lowering that begins no height transition [m].
        offset_ticks: plans for which an offset of the legs serves; making it costs more than the rest of one [-].
        same_swing: shift of a footstep for which it serves: it moves the DCM by less than a millimetre [m].
    """

    second_weight: float = quantity(1.0, "1/m^2")
    shift_weight: float = quantity(0.02, "1/m^2")
    time_weight: float = quantity(0.38, "-")
    stretch_weight: float = quantity(1.0, "1/m^2")
    swing_weight: float = quantity(40.0, "1/m^2")
    cross_factor: float = quantity(3.0, "-")
    least_saving: float = quantity(0.001, "-")
    cop_share: float = quantity(0.8, "-")
    landing_share: float = quantity(0.5, "-")
    landing_spare: float = quantity(0.03, "m")
    tolerance: float = quantity(0.02, "m")
    unheld_share: float = quantity(0.5, "-")
    stand_share: float = quantity(0.85, "-")
    again_cost: float = quantity(1.75, "-")
    time_changes: tuple[float, ...] = quantity(tuple(map(float, _TIME_CHANGES)), "s")
    least_double: float = quantity(0.04, "s")
    least_single: float = quantity(0.10, "s")
    apart: float = quantity(0.03, "m")
    calm: float = quantity(0.005, "m")
    margin_times: tuple[float, ...] = quantity((0.0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.7, 1.0), "-")
    longer: float = quantity(0.2, "s")
    most_steps: int = 5
    fall_margin: float = quantity(0.15, "m")
    fall_plans: int = 3
    regained_plans: int = 5
    sole_gap: float = quantity(0.01, "m")
    across: float = quantity(0.12, "m")
    clear: float = quantity(0.02, "m")
    spanned: float = quantity(0.75, "-")
    parallel: float = quantity(0.02, "-")
    lifting: float = 5.0
    same_height: float = quantity(0.005, "m")
    offset_ticks: int = 5
    same_swing: float = quantity(0.005, "m")

    @property
    def longest_cut(self) -> float:
        """The greatest cut among the changes of a time [s]. It is infinite without any cut."""
        return max(-min(self.time_changes, default=0.0), 0.0) or math.inf


_ZERO_TOO = (
    "late_touchdown", "freeze_time", "freeze_catching", "touchdown_lead", "terminal_weight", "jerk_weight",
    "compliance_margin",
)  # fmt: skip


@dataclass(frozen=True, slots=True)
class PlannerParameters:
    """Parameters of the walking planner; the defaults are the measured robust formulation, for the reference robot.

    Those of a robot of another size are these, scaled by their units (see `surefoot.similarity`).

    Attributes:
        sample_time: T_s [s].
        horizon: samples over which the jerk is planned (N_p).
        preview: samples beyond the horizon in which known footsteps still shape the terminal DCM bound and ω.
        moves: first sample of each block of constant jerk (see `planner.model.jerk`).
        jerk_limit: bound of the CoM jerk per axis [m/s^3].
        jerk_rate_limit: bound of its change from one block to the next [m/s^3 per sample]; infinite for none.
        jerk_weight: cost of a squared move, against 1 for a squared ZMP error [(m / (m/s^3))^2].
        terminal_weight: cost of the squared DCM error at the end of the horizon; 2 / (ω T_s) is the cost-to-go of the
            best linear DCM feedback, 32 at 1 m [-].
        step_weight: cost of a squared footstep shift; smaller ones shorten the nominal steps [-].
        zmp_slack: quadratic and linear cost of leaving the ZMP box [-, m].
        terminal_slack: quadratic and linear cost of leaving the terminal DCM bound [-, m].
        foot_margin: share of the foot in which the ZMP must stay (the paper's 90 %) [-].
        cop_room: how far from the sole's centre, forward and sideways, the ankles' torques let the CoP go [m].
        cop_authority: how far the CoP of one foot can be moved against a disturbance, forward and sideways; feet that
            stand on an edge have none sideways, and a step catches what other feet would hold [m].
        terminal_margin: share of the box's half size that bounds the terminal DCM [-].
        leg: inertia of the legs; the default is the paper's point mass without any.
        step_adaptation: what a disturbance may change about the footsteps.
        reach_length: largest distance of a footstep ahead of or behind the stance foot [m].
        reach_width: smallest and largest lateral distance of a footstep from the stance foot [m].
        compliance_margin: change of a footstep that the paper's step law does not ask for [m].
        swing_speed: fastest mean speed of the swing foot to a shifted footstep, where the legs are not known [m/s].
        freeze_time: time before touchdown from which the footstep is fixed [s].
        freeze_catching: that time of a step that catches the body, since until then the DCM may go on elsewhere; not on
            faces that were chosen [s].
        late_touchdown: longest wait of the phase clock for a touchdown [s].
        apex_share: share of single support after which the swing sole is highest; a late apex keeps the sole high while
            the leg is stretched furthest, shortly before touchdown [-].
        touchdown_lead: the swing ends this long before single support does, so that the foot is felt in time [s].
        search: speed of the swing foot at the planned touchdown, and how it goes on while it feels no ground.
        recovery: numbers of step adjustment, capture margin and what belongs to them.
        solvers: QP solvers of qpsolvers, in the order in which they are tried (see `planner.laws.law` for the choice).
        size: of the robot, for what is no parameter: the planner's constants are the reference robot's.

    Raises:
        ParameterError: a number is not positive, or not finite where it must be.
    """

    sample_time: float = quantity(0.02, "s")
    horizon: int = 50
    preview: int = 100
    moves: tuple[int, ...] = BLOCK_STARTS
    jerk_limit: float = quantity(60.0, "m/s^3")
    jerk_rate_limit: float = quantity(math.inf, "m/s^3")
    jerk_weight: float = quantity(1e-6, "s^6")
    terminal_weight: float = quantity(32.0, "-")
    step_weight: float = quantity(30.0, "-")
    zmp_slack: tuple[float, float] = quantity((1e3, 30.0), "-, m")
    terminal_slack: tuple[float, float] = quantity((1e3, 10.0), "-, m")
    foot_margin: float = quantity(0.9, "-")
    cop_room: tuple[float, float] = quantity((math.inf, math.inf), "m")
    cop_authority: tuple[float, float] = quantity((math.inf, math.inf), "m")
    terminal_margin: float = quantity(0.8, "-")
    leg: LegInertia = LegInertia()
    step_adaptation: StepAdaptation = StepAdaptation.CROSSING
    reach_length: float = quantity(0.4, "m")
    reach_width: tuple[float, float] = quantity((0.08, 0.4), "m")
    compliance_margin: float = quantity(0.05, "m")
    swing_speed: float = quantity(3.0, "m/s")
    freeze_time: float = quantity(0.08, "s")
    freeze_catching: float = quantity(0.04, "s")
    late_touchdown: float = quantity(0.3, "s")
    apex_share: float = quantity(0.5, "-")
    touchdown_lead: float = quantity(0.02, "s")
    search: GroundSearch = field(default_factory=GroundSearch)
    recovery: RecoveryParameters = RecoveryParameters()
    solvers: tuple[str, str] = SOLVERS
    size: Similarity = REFERENCE_SIZE

    def __post_init__(self) -> None:
        for entry in fields(self):
            value = getattr(self, entry.name)
            if not isinstance(value, int | float) or 0 < value < math.inf:
                continue
            key, what = ("parameters", entry.name), f"{entry.name} is {value:g}"
            if not (value > 0 or (entry.name in _ZERO_TOO and value == 0)):
                raise ParameterError(key, what, "it must be greater than 0")
            if not math.isfinite(value) and entry.name != "jerk_rate_limit":
                raise ParameterError(key, what, "it must be finite")
