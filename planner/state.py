"""The state of a walk: all that the planner carries from one tick to the next, as one value."""

from dataclasses import dataclass, field, replace
from enum import Enum

import numpy as np

from surefoot.planner.model.time_scaling import TimeScaling
from surefoot.planner.plan.plan import WalkPlan
from surefoot.planner.references.height_transition import HeightTransition
from surefoot.planner.references.offset_table import OffsetTable
from surefoot.planner.references.zmp_reference import Support
from surefoot.planner.steps import adaptation
from surefoot.planner.steps.beginning import begun, in_sight
from surefoot.planner.steps.gait import GaitParameters
from surefoot.planner.steps.phases import Phase, PhaseSamples
from surefoot.planner.steps.schedule import Schedule
from surefoot.planner.steps.source import CommandSource
from surefoot.planner.swing.rolling import FootRoll, pivot_of
from surefoot.planner.swing.trajectory import SwingTrajectory
from surefoot.planner.types import Array, FeetState, PhaseInfo
from surefoot.planner.walk_model import WalkModel

_SAME_TIME = 1e-3
"""Difference of a phase's time left that is not worth another time scaling, of the reference robot [s]."""


class SwingStage(Enum):
    """The stage of the step that lands next.

    FLYING: its place and time are free. DECIDED: they are not any more. SEARCHING: its time is over, and its foot has
    not found the ground. LANDED: its foot was felt before its time.
    """

    FLYING = "flying"
    DECIDED = "decided"
    SEARCHING = "searching"
    LANDED = "landed"


@dataclass(frozen=True)
class Swing:
    """The swing of the step that lands next.

    Attributes:
        stage: how far it is.
        trajectory: of its foot; None while that stands.
        waited: ticks for which the clock has waited for its touchdown.
    """

    stage: SwingStage = SwingStage.FLYING
    trajectory: SwingTrajectory | None = None
    waited: int = 0


@dataclass(frozen=True)
class HeightMemory:
    """The CoM height that the last look saw.

    Attributes:
        tick: of the clock.
        course: of the clock's last time scaling.
        height: z, z', z'' now and a sample later, shape (3, 2) [m, m/s, m/s^2].
        lower: how much lower than by its law it was [m].
    """

    tick: int
    course: tuple[float, tuple[float, ...]]
    height: Array
    lower: float


@dataclass(frozen=True)
class Memory:
    """The memory that one look leaves to the next.

    Attributes:
        support: what carried the robot, which goes on while its key stays: to make it takes longer than ZMP reference,
            height and ω of a window together.
        offsets: what the legs add to the ZMP, for some ticks.
        transition: of the CoM height to its law; None where it is on it.
        height: as it was seen; None before the first look.
    """

    support: Support | None = None
    offsets: OffsetTable | None = None
    transition: HeightTransition | None = None
    height: HeightMemory | None = None


@dataclass(frozen=True)
class Orders:
    """The commands that the walk has been given.

    Attributes:
        source: of the steps to come; None for those of the gait.
        gait: durations and swing height from the next plan on, and a source; None where nothing is new.
    """

    source: CommandSource | None = None
    new: tuple[GaitParameters, CommandSource | None] | None = None


@dataclass(frozen=True, eq=False)
class WalkState:
    """A walk at an instant. Whatever happens, or is decided, makes another state of it.

    Attributes:
        model: what stays the same.
        schedule: the steps in sight, which reach as far as any plan of the present phase looks.
        clock: that of the gait.
        phase: the phase now.
        stops: the robot stands, or will with the next step that lands.
        landed: number of the step that landed last; its foot is the stance foot in single support.
        swing: of the step that lands next.
        adapted: place or time of that step are being adapted.
        lowering: how much lower than by its law the CoM is for legs to span that step, or the one just landed [m].
        astray: by how much the ground is off its map where the robot stands, see `GroundSearch.astray` [m].
        memory: of the last look.
        orders: the commands to the walk.
        plan: the last one; None before the first.
        law_memory: vectors that the law's last motion left, in the world frame; None where it left none.
    """

    model: WalkModel
    schedule: Schedule
    clock: TimeScaling
    phase: Phase
    stops: bool
    landed: int = 0
    swing: Swing = field(default_factory=Swing)
    adapted: bool = False
    lowering: float = 0.0
    astray: float = 0.0
    memory: Memory = field(default_factory=Memory)
    orders: Orders = field(default_factory=Orders)
    plan: WalkPlan | None = None
    law_memory: Array | None = None

    @classmethod
    def start(cls, model: WalkModel, feet: FeetState) -> "WalkState":
        """The state before the first tick.

        Args:
            model: of the walk.
            feet: where they stand.

        Raises:
            ParameterError: see `Schedule.extended`.
        """
        schedule = begun(model.gait, feet, model.ground, model.reach + 1)
        clock = TimeScaling(model.parameters.sample_time)
        return cls(model, schedule, clock, schedule.phase(0.0), schedule.stops(0.0))

    # What follows from a state.

    @property
    def info(self) -> PhaseInfo:
        """The phase now, in seconds."""
        phase, t = self.phase, self.clock.sample_time
        elapsed, duration = (self.clock.now - phase.start) * t, phase.samples * t
        follows = phase if phase.stance is not None else self.schedule.phase(phase.end)
        leads_to = follows.step if follows.stance is not None else 0
        return PhaseInfo(phase.kind, phase.stance, phase.step, elapsed, duration, leads_to, self.time_left)

    @property
    def left(self) -> float:
        """Time until the present phase ends [samples]."""
        return self.clock.until(self.phase.end)

    @property
    def time_left(self) -> float:
        """Time until the present phase ends [s]."""
        return self.left * self.clock.sample_time

    @property
    def decided(self) -> bool:
        """The step that lands next may not be moved any more."""
        return self.swing.stage is not SwingStage.FLYING

    @property
    def free(self) -> tuple[bool, bool]:
        """True for each of the next two footsteps that exists and may be shifted."""
        adapts, remaining = self.model.adapts, self.schedule.last.number - self.landed
        return (adapts and remaining >= 1 and not self.decided, adapts and remaining >= 2)

    @property
    def catching(self) -> bool:
        """The next footstep is adapted on free ground; where faces were chosen the CoM's height does not follow it."""
        return self.adapted and self.model.follows

    @property
    def aim(self) -> Array | None:
        """Target of a swing that deviates from its step, shape (3,) [m]; None if none does."""
        swing = self.swing.trajectory
        return None if swing is None or not (self.adapted or swing.bent) else swing.footstep

    @property
    def aimed(self) -> Schedule:
        """The schedule, with the step that is being swung where its foot now goes."""
        aim = self.aim
        return self.schedule if aim is None or self.decided else self.schedule.moved(self.landed + 1, aim)

    def samples(self, count: int) -> PhaseSamples:
        """The phases at `count` samples from now on, with one more before them and one after."""
        ahead = np.arange(-1.0, count + 1)
        if self.clock.steady:
            clock = self.clock.now + ahead
            clock[0] = max(clock[0], 0.0)
            return self.schedule.samples(clock)
        clock, rate, bend = self.clock.at(ahead)
        return self.schedule.samples(clock, (rate, bend / self.clock.sample_time))

    def rolls(self, time: float) -> tuple[FootRoll, ...]:
        """Rolls of the present phase that are not over, at a time [s]."""
        clock = self.clock
        scaling, half_length, found = None if clock.steady else clock, float(self.model.half_size[0]), []
        for foot, begin, over, angle in self.phase.rolls:
            if clock.now < over:
                start, end = (time + (at - clock.now) * clock.sample_time for at in (begin, over))
                found.append(FootRoll(foot, start, end, angle, pivot_of(angle, half_length), scaling, time))
        return tuple(found)

    # From a state to the next.

    def on(self, schedule: Schedule, clock: TimeScaling | None = None) -> "WalkState":
        """The state in which the walk goes on by a schedule, seen as far as any plan of the present phase looks.

        Args:
            schedule: the steps.
            clock: that of the gait; the present one by default.

        Raises:
            ParameterError: see `Schedule.extended`.
        """
        clock = clock or self.clock
        now = max(clock.now, 0.0)
        seen = in_sight(schedule, now, self.model.reach + 1)
        return replace(self, clock=clock, schedule=seen, phase=seen.phase(now), stops=seen.stops(now))

    def deciding(self, position: Array, stage: SwingStage = SwingStage.DECIDED) -> "WalkState":
        """The state in which the next footstep lands at a place, shape (3,) [m], and is not moved any more."""
        schedule = self.schedule.moved(self.landed + 1, position)
        return replace(self, schedule=schedule, swing=replace(self.swing, stage=stage))

    def swinging_anew(self, clock: TimeScaling) -> "WalkState":
        """The state in which the swing begins again, on a clock that shows what it did when its phase began."""
        start = self.phase.start
        schedule = adaptation.with_clock_put_back(self.schedule, self.phase.rolls, clock.now, start)
        state = replace(self, clock=clock.showing(start), swing=Swing())
        return state if schedule is self.schedule else state.on(schedule)

    def landing(self, position: Array, clock: TimeScaling) -> "WalkState":
        """The state in which the swing foot has landed at a place, shape (3,) [m], when the clock shows this."""
        model, landed = self.model, self.landed + 1
        schedule = self.schedule.forgotten(clock.now).moved(landed, position)
        if self.adapted and model.legs is not None:
            schedule = adaptation.with_heel_lifted(schedule, landed, model.legs.radius)
            schedule = schedule if model.follows else adaptation.aligned(schedule, landed)
        return replace(self, landed=landed, swing=Swing(), adapted=False).on(schedule, clock)

    def ending_in(self, left: float, time: float) -> "WalkState":
        """The state in which the present phase ends at another time, or as near to it as the clock can.

        Args:
            left: time from now on [s].
            time: now [s].

        Returns:
            This state, where that time is no other.
        """
        before, t = self.time_left, self.clock.sample_time
        if abs(left - before) < _SAME_TIME * self.model.parameters.size.time:
            return self
        clock = self.clock.scaled(self.phase.end - self.clock.now, left / t)
        state, schedule = replace(self, clock=clock), self.schedule
        # A heel rises only as far as it is lifted no harder than hips swing a foot, and so do toes.
        spans = [span for span in self.phase.rolls if clock.now < span.end]
        for span, roll in zip(spans, state.rolls(time), strict=True):
            share = roll.bearable(self.model.hardest, time, time + state.time_left)
            if share < 1.0:
                schedule = adaptation.with_roll(schedule, span, share * span.angle)
        return state.on(schedule).swing_put_off(time, before)

    def swing_put_off(self, time: float, left: float) -> "WalkState":
        """The state whose swing is later by as much as its phase, of which a time had been left [s]."""
        swing = self.swing.trajectory
        if swing is None or self.time_left == left:
            return self
        swing = swing.retimed(time, self.time_left - left, self.clock.sample_time)
        return replace(self, swing=replace(self.swing, trajectory=swing))
