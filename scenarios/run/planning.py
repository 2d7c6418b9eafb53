"""The planner inside a closed loop, on its own clock and logged, and what it asks of the whole-body controller."""

import math
from collections import deque
from collections.abc import Callable, Sequence
from typing import Protocol, cast

import numpy as np
from numpy.typing import NDArray

from surefoot.errors import ParameterError
from surefoot.guard import OWN_GUARD, Guard
from surefoot.planner.geometry import sole_rates, sole_rotation
from surefoot.planner.plan import Planner, PlanSample, PlanSampler, WalkPlan
from surefoot.planner.steps.commands import Command
from surefoot.planner.types import CentroidalState, FeetState, Foot, Footstep, PhaseKind
from surefoot.scenarios.file.schema import Fault, Rates
from surefoot.scenarios.record.walk import WalkRecorder
from surefoot.scenarios.run.sensing import PlannerSensing
from surefoot.scenarios.setup.events import FaultWindow
from surefoot.scenarios.setup.parts import plan as taken_plan
from surefoot.wbc.types import WbcReference

ROUNDING = 1e-6
"""Times of commands are compared with those of ticks with this tolerance [ticks]."""


class RunFault(Exception):  # noqa: N818  the event, not a mistake of the caller
    """What ends a run before its time, in words."""


class CommandedPlanner(Planner, Protocol):
    """A planner that hears while the walk goes on what to do, as `surefoot.planner.planner.WalkingPlanner`."""

    @property
    def orders(self) -> Command:
        """What the walk does of what it has been told."""

    def command(self, command: Command) -> None:
        """Do something else from the next plan on.

        Raises:
            ParameterError: it cannot do this.
        """


class FaultSchedule:
    """Time windows of injected faults on the control clock."""

    def __init__(self, faults: Sequence[Fault], control_rate: int) -> None:
        """Faults with times in seconds, on a clock of ``control_rate`` [Hz]."""
        self._windows = tuple(FaultWindow.of(fault, control_rate) for fault in faults)

    def active(self, kind: str, tick: int) -> bool:
        """Whether a fault of that kind acts at that control tick."""
        return any(window.kind == kind and window.holds(tick) for window in self._windows)


class Planning:
    """Planner, its sensing, its latest plan, and the record of all.

    A command is taken by the first plan at or after its time.

    Args:
        planner: what plans.
        sensing: what it is told of the state.
        recorder: of its channels.
        faults: injected.
        rates: of the clock.
        commands: that it hears while the walk goes on.
        guard: around the calls of the planner.

    Attributes:
        planner: what plans.
        plan: the latest plan; there is none before the first `update`.
        sampler: of the latest plan.
    """

    def __init__(
        self,
        planner: Planner,
        sensing: PlannerSensing,
        recorder: WalkRecorder,
        faults: FaultSchedule,
        rates: Rates,
        commands: Sequence[Command] = (),
        guard: Guard = OWN_GUARD,
    ) -> None:
        self.planner, self._sensing, self._recorder, self._faults = planner, sensing, recorder, faults
        self._guard = guard
        self._every, self._rate = rates.control // rates.planner, rates.control
        self.plan: WalkPlan
        self.sampler: PlanSampler
        self._started = False
        self._commands = deque(sorted(commands, key=lambda command: command.time))
        self._told = False
        self._aim: Footstep | None = None
        self._landing: Footstep | None = None

    def due(self, tick: int) -> bool:
        """Whether the planner measures at a control tick."""
        return tick % self._every == 0

    def update(self, tick: int, now_ns: int, state: CentroidalState, zmp: NDArray[np.float64], feet: FeetState) -> None:
        """Measure and plan; a frozen planner only measures, but the first plan is made whatever the faults say.

        Args:
            tick: control tick.
            now_ns: its time [ns].
            state: CoM without noise, as the planner's robot model has it.
            zmp: ZMP without noise, shape (2,) [m].
            feet: the feet, which are measured without noise.
        """
        before = self.plan if self._started else None
        sensed = self._sensing.sense(state, zmp, before)
        self._recorder.planner_state(now_ns, sensed)
        if self._started and self._faults.active("planner_freeze", tick):
            return
        self._tell(tick)
        update: Callable[[CentroidalState, FeetState], WalkPlan] = self._guard.function(self.planner.update, taken_plan)
        self.plan = plan = update(sensed.given, feet)
        self.sampler = PlanSampler(plan)
        self._started = True
        self._recorder.plan(now_ns, plan)
        if self._told:
            self._recorder.command(now_ns, self.orders)
            self._told = False
        self._book(now_ns, before, feet)

    def command(self, command: Command, tick: int) -> None:
        """Tell the planner something at a control tick, from the next plan on.

        Raises:
            ParameterError: it is a planner that takes no commands, or cannot do this.
        """
        self._commanded  # noqa: B018  refuses before the planner hears what it was to hear earlier
        self._tell(tick)
        self._say(command)

    @property
    def orders(self) -> Command:
        """What the walk does of what it has been told.

        Raises:
            ParameterError: it is a planner that takes no commands.
        """
        with self._guard:
            return self._commanded.orders

    @property
    def _commanded(self) -> CommandedPlanner:
        if not hasattr(self.planner, "command"):
            what = f"a command to {type(self.planner).__name__}, which takes none"
            raise ParameterError(("commands",), what, "use a profile with surefoot's own walking planner")
        return cast("CommandedPlanner", self.planner)

    def _say(self, command: Command) -> None:
        with self._guard.making:
            self._commanded.command(command)
        self._told = True

    def _tell(self, tick: int) -> None:
        """Tell the planner what it is to hear at a control tick or was to hear since its last plan."""
        while self._commands and self._commands[0].time * self._rate <= tick + ROUNDING:
            self._say(self._commands.popleft())

    def _book(self, now_ns: int, before: WalkPlan | None, feet: FeetState) -> None:
        """Record a footstep once its swing is over and its foot has touched down, which it may never do.

        What was planned of it is what the last plan before the touchdown said: the planner moves the footstep of a foot
        that has touched down early to where it stands.
        """
        swinging = _swinging(self.plan)
        if before is not None and (foot := _swinging(before)) is not None and swinging is not foot:
            self._landing = self._aim
        landing = self._landing
        if landing is not None and landing.foot is swinging:
            self._landing = None
        elif landing is not None and feet.contact[landing.foot]:
            self._recorder.touchdown(now_ns, landing, feet)
            self._landing = None
        if swinging is not None and not self.plan.status.early_touchdown:
            self._aim = self.plan.footsteps[0]


def _swinging(plan: WalkPlan) -> Foot | None:
    """The foot that swings in a plan's phase."""
    stance = plan.phase.stance
    return stance.other if plan.phase.kind is PhaseKind.SINGLE and stance is not None else None


def whole_body_reference(plan: WalkPlan, sample: PlanSample) -> WbcReference:
    """What the whole-body controller shall do at the sample's instant of the plan, or over a tick that it stands for.

    The heading of pelvis and torso is the mean of both feet's yaws, so that it turns smoothly with the swing foot.
    """
    phase = plan.phase
    lifts = phase.kind is PhaseKind.DOUBLE and phase.leads_to > 0
    passed = phase.elapsed + sample.time - plan.time
    swing, rate, bend = sample.swing, sample.swing_velocity, sample.swing_acceleration
    roll = plan.roll
    foot = -1 if sample.swing_foot is None else int(sample.swing_foot)
    yaw = [plan.footholds[0].yaw, plan.footholds[1].yaw]
    normal = np.array([plan.footholds[0].normal, plan.footholds[1].normal])
    if foot >= 0:
        yaw[foot] = float(swing[3])
        normal[foot] = plan.footsteps[0].normal
    turning, bending = sole_rates(swing[3:], rate[3:], bend[3:])
    return WbcReference(
        com=sample.com,
        com_velocity=sample.com_velocity,
        com_acceleration=sample.com_acceleration,
        zmp=sample.pendulum_zmp,
        zmp_offset=sample.zmp - sample.pendulum_zmp,
        omega=sample.omega,
        stiffness=sample.stiffness,
        heading=0.5 * (yaw[0] + yaw[1]),
        heading_rate=0.5 * float(rate[3]),
        planned_contact=sample.contacts,
        load_share=(sample.load_left, 1.0 - sample.load_left),
        time_to_switch=max(0.0, phase.left - (sample.time - plan.time)),
        lifting_foot=int(plan.footsteps[0].foot) if lifts else -1,
        swing_foot=foot,
        swing_progress=min(1.0, passed / phase.duration) if foot >= 0 and math.isfinite(phase.duration) else 0.0,
        swing_position=swing[:3],
        swing_velocity=rate[:3],
        swing_acceleration=bend[:3],
        swing_rotation=sole_rotation(*swing[3:].tolist()),
        swing_angular_velocity=turning,
        swing_angular_acceleration=bending,
        ground_normal=normal,
        rolling_foot=-1 if roll is None or not roll.rolling(sample.time) else int(roll.foot),
        roll=(0.0, 0.0, 0.0) if roll is None else roll.evaluate(sample.time),
    )
