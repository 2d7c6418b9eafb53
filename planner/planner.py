"""The walking planner: the four modules of the paper, put together once per tick."""

import math
from copy import copy
from dataclasses import replace
from functools import partial

import numpy as np

from surefoot.errors import ParameterError
from surefoot.planner.check import check_durations, check_height
from surefoot.planner.ground.terrain import Terrain, flat
from surefoot.planner.laws.law import Motion, MotionProblem, StepContext
from surefoot.planner.laws.profiles import PROFILES, Profile
from surefoot.planner.model.world_motion import WorldMotion
from surefoot.planner.parameters import PlannerParameters
from surefoot.planner.plan import WalkPlan
from surefoot.planner.recovery.recovery import Recovery, Sight, falling
from surefoot.planner.recovery.step_problem import StepBounds, StepProblem
from surefoot.planner.references.com_height import HeightProfile, SmoothHeight
from surefoot.planner.references.window import ReferencePreview, Window
from surefoot.planner.references.zmp_reference import Support
from surefoot.planner.steps.adaptation import Dcm
from surefoot.planner.steps.beginning import begun
from surefoot.planner.steps.commands import STANDING, Command
from surefoot.planner.steps.execution import Execution
from surefoot.planner.steps.gait import GaitParameters
from surefoot.planner.steps.schedule import Schedule
from surefoot.planner.steps.source import CommandSource
from surefoot.planner.swing.course import Ground
from surefoot.planner.swing.leg_reach import LegReach
from surefoot.planner.swing.step_region import StepRegion
from surefoot.planner.types import (
    Array,
    Balance,
    CentroidalState,
    FeetState,
    Footstep,
    PhaseKind,
    PlanStatus,
    SolverStatus,
)

_STILL = np.zeros(3)


class WalkingPlanner:
    """Receding-horizon planner of CoM, ZMP and footsteps, from the measured state at every tick.

    It plans in a frame with origin and planned heading at the stance foot (the foot landed last in double support), so
    that its numbers do not depend on where in the world it walks, and ZMP boxes and reach boxes are aligned with it.
    CoM position and velocity come from the measurement, the acceleration from the plan before. How the CoM moves is
    the profile's law of motion (see `planner.laws.profiles`); all else is common to the profiles.

    Args:
        gait: the walk.
        feet: where the feet stand at the start.
        foot_length: length of the sole [m].
        foot_width: width of the sole [m].
        terrain: what the planner believes about the ground.
        parameters: the planner's own parameters; those of the profile by default.
        height_profile: vertical CoM motion; that of the profile, or else the smooth one, by default.
        profile: formulation of the planner; the robust one by default.
        region: where a step that is commanded may land; where the parameters let it by default.
        legs: what they can do to catch the body; None lets steps be moved where the parameters let them, and only that.

    Attributes:
        gait: the walk.
        parameters: the planner's own parameters.
        motion: the law's answer of the last tick, with the QPs that it solved; None before the first.

    Raises:
        ParameterError: of the steps in sight, a footstep is out of reach, the CoM would fall almost freely, or no swing
            clears the edges before a footstep; `planner.check.check_walk` looks at all of a walk.
    """

    def __init__(
        self,
        gait: GaitParameters,
        feet: FeetState,
        foot_length: float,
        foot_width: float,
        terrain: Terrain | None = None,
        parameters: PlannerParameters | None = None,
        height_profile: HeightProfile | None = None,
        profile: Profile = PROFILES["default"],
        region: StepRegion | None = None,
        legs: LegReach | None = None,
    ) -> None:
        self.gait = gait
        self.parameters = parameters or profile.parameters
        p = self.parameters
        terrain = terrain or flat()
        for name, size in (("foot_length", foot_length), ("foot_width", foot_width)):
            if not (size > 0.0 and math.isfinite(size)):
                raise ParameterError((name,), f"{name} is {size:g}", "it must be a finite number greater than 0")
        half_size = 0.5 * np.array([foot_length, foot_width])
        heights = height_profile or profile.height or SmoothHeight()
        self._preview = ReferencePreview(gait, heights, p, half_size)
        schedule = begun(gait, feet, Ground(terrain, half_size, p), self._preview.reach + 1)
        legs = legs.adapting(p) if legs is not None and profile.catches else None
        self._execution = Execution(schedule, self._preview.reach + 1, legs)
        self._recovery = Recovery(self._execution, half_size)
        heights_ahead = self._execution.schedule.support_points[:, 2]
        check_height(heights, gait, self._execution.samples(self._preview.reach), heights_ahead)
        self._world = WorldMotion(p.sample_time, p.horizon)
        self._law = profile.law(p, heights.standing(gait))
        self._plan: WalkPlan | None = None
        region = region or StepRegion(p.reach_length, p.reach_width, (foot_length, foot_width), p.recovery.sole_gap)
        self._region, self._bare = region, not terrain.has_edges
        self._source: CommandSource | None = None
        self._told: tuple[GaitParameters, CommandSource | None] | None = None
        self.motion: Motion | None = None

    @property
    def schedule(self) -> Schedule:
        """The steps in sight: landed ones as measured, the others as nominally planned from them."""
        return self._execution.schedule

    @property
    def orders(self) -> Command:
        """What the walk does of what it has been told, with the velocity that it follows."""
        source, gait = self._source, self._execution.schedule.gait
        now = Command(None, None, gait.single_support, gait.double_support, gait.swing_height)
        if source is None:
            return now
        if source.places:
            return replace(now, places=source.places)
        return replace(now, twist=source.twist, followed=source.followed(gait.period), march=source.march)

    def command(self, command: Command) -> None:
        """Do something else from the next plan on; of two commands before it the later one holds.

        A step that is being swung, or to which the weight is being shifted, is taken as it was planned. What is left of
        the present phase changes in proportion to its duration.

        Args:
            command: what changes.

        Raises:
            ParameterError: the ground has edges, for which footsteps and swings were laid, or the CoM would fall almost
                freely in phases that short.
        """
        if not self._bare:
            what = "a command on ground with edges, for which footsteps and swings were laid"
            raise ParameterError(("command",), what, "command a walk on bare ground")
        changed = {name: getattr(command, name) for name in ("single_support", "double_support", "swing_height")}
        gait, told = self._told or (self._execution.schedule.gait, None)
        gait = replace(gait, **{name: value for name, value in changed.items() if value is not None})
        check_durations(gait, self.parameters.sample_time)
        # Steps of a source that is kept are asked for anew, too: their strides follow from the durations.
        source = told or self._source
        if command.twist is not None or command.places is not None or command.march:
            size, twist = self.parameters.size, command.twist or STANDING
            source = CommandSource(self.gait, self._region, twist, command.places or (), size, command.march)
        self._told = gait, source

    def _obey(self, time: float) -> None:
        """Do what has been commanded since the last plan."""
        if self._told is not None:
            gait, source = self._told
            self._execution.change(gait, source, time)
            self._told, self._source = None, source or self._source

    def update(self, state: CentroidalState, feet: FeetState) -> WalkPlan:
        """Plan from a measurement; call it once per sample time.

        Args:
            state: measured CoM.
            feet: measured feet.

        Raises:
            ValueError: the measured CoM or feet are not finite.
        """
        body, soles = (*state.com.tolist(), *state.com_velocity.tolist()), feet.position.ravel().tolist()
        measured = (*body, *soles, *feet.yaw.tolist())
        if not all(map(math.isfinite, measured)):
            raise ValueError(f"The measured CoM or feet are not finite at {state.time:g} s.")
        execution, time = self._execution, state.time
        dcm, see = partial(self._dcm, state), partial(self._sight, state)
        execution.advance(feet, dcm)
        self._obey(time)
        execution.fix_imminent(time, feet, 0.0 if self._plan is None else self._plan.balance.planned)
        sight = see()
        support, local, window = self._recovery.landing(feet, dcm, see, sight) if execution.adapted else sight
        if self._recovery.steps_out(local, window):
            support, local, window = see()
        # Online constraints generator: the box comes with the reference, the reach of the feet here.
        unsure = self._unsure(state, window)
        step = StepProblem.of(time, execution, feet, support.frame)
        balance = self._recovery.balance(step, local, support, window, self._plan, unsure)
        if self._recovery.goes_again(time, feet, see, (support, local, window), balance, unsure):
            support, local, window = see()
            step = StepProblem.of(time, execution, feet, support.frame)
            balance = self._recovery.balance(step, local, support, window, self._plan, unsure)
        adjusted = self._recovery.adjusted(step, local, window, unsure)
        if adjusted is not None and adjusted.more and self._recovery.adds_steps(balance.planned):
            support, local, window = see()
            step = StepProblem.of(time, execution, feet, support.frame)
            adjusted = self._recovery.adjusted(step, local, window, unsure)
        left = execution.time_left
        if adjusted is not None and execution.end_in(adjusted.left, time):
            window = self._preview.window(execution, support, local[:, 0], time, state.lasting)
            balance = replace(balance, delay=balance.delay + (execution.time_left - left))
        free = execution.free
        problem = self._problem(local, support, window, step, adjusted, free)
        # TVMPC, or the law that stands in its place.
        motion = self.motion = self._law.plan(problem)
        shifts = motion.shifts @ support.rotation.T if any(motion.shifts.ravel().tolist()) else np.zeros((2, 2))
        footsteps = execution.upcoming(time, free, shifts)
        catching = execution.catching
        if free[0] or catching:
            shift = shifts[0] if free[0] else balance.shift
            counts = balance.lost, catching, balance.safe
            balance = Balance(balance.planned, balance.movable, shift, balance.delay, *counts)
        if execution.phase.swing_foot is not None:
            execution.swing_to(footsteps[0], time, feet, motion.solver is SolverStatus.HELD)
        self._plan = self._world_plan(time, support, window, local, motion, footsteps, balance)
        return self._plan

    def _dcm(self, state: CentroidalState) -> Dcm | None:
        """DCM in the world frame by the ω of the last plan, and that [m, 1/s]; None without one."""
        if self._plan is None:
            return None
        (x, y, _), (u, v, _), omega = state.com.tolist(), state.com_velocity.tolist(), self._plan.omega.item(0)
        return x + u / omega, y + v / omega, omega

    @staticmethod
    def _unsure(state: CentroidalState, window: Window) -> float:
        """Two standard deviations of the DCM [m]."""
        com, velocity = state.deviation
        if not com and not velocity:
            return 0.0
        return 2.0 * math.hypot(com, velocity / float(window.omega[0]))

    def _sight(self, state: CentroidalState, other: Execution | None = None) -> Sight:
        """What carries the robot now, its CoM in that plan frame, and the references from now on.

        Of another execution it is what would be seen: the preview goes on from what it has seen of its own.
        """
        execution, preview = (self._execution, self._preview) if other is None else (other, copy(self._preview))
        support = preview.support(execution)
        # Position and velocity as measured, acceleration as the last plan had it for now.
        bend = _STILL if self._plan is None else self._plan.com_acceleration[1]
        local = self._world.local(state.com, state.com_velocity, bend, support.frame)
        return support, local, preview.window(execution, support, local[:, 0], state.time, state.lasting)

    def _world_plan(
        self,
        time: float,
        support: Support,
        window: Window,
        local: Array,
        motion: Motion,
        footsteps: tuple[Footstep, ...],
        balance: Balance,
    ) -> WalkPlan:
        """What a tick has decided, in the world frame."""
        execution, reference, count = self._execution, window.reference, self.parameters.horizon + 1
        stiffness, offset = window.stiffness[:count], window.offset[:count]
        ahead = stiffness, window.height.height[:, :count], offset, reference.point[:count], reference.gain[:count]
        frame = support.rotation, support.origin
        com, jerk, zmp, offset, point = self._world.of(local, motion.jerk, motion.shifts, ahead, frame)
        return WalkPlan(
            time=time,
            sample_time=self.parameters.sample_time,
            com=com[0],
            com_velocity=com[1],
            com_acceleration=com[2],
            jerk=jerk,
            zmp=zmp,
            zmp_offset=offset,
            zmp_reference=point,
            stiffness=stiffness,
            omega=window.omega[:count],
            phase=execution.info,
            contacts=window.contacts[:count],
            load_left=window.load_left[:count],
            support_polygon=support.outer,
            inner_polygon=support.inner,
            footholds=support.footholds,
            footsteps=footsteps,
            swing=execution.swing,
            roll=execution.roll(time),
            status=self._status(motion, balance),
            balance=balance,
        )

    def _problem(
        self,
        local: Array,
        support: Support,
        window: Window,
        step: StepProblem | None,
        adjusted: StepBounds | None,
        free: tuple[bool, bool],
    ) -> MotionProblem:
        before = np.zeros((self.parameters.horizon, 2)) if self._plan is None else self._plan.jerk
        ahead = window.stiffness, window.omega, window.driving
        steps = self._step_context(support, step, adjusted, free)
        return MotionProblem.after(before, local, ahead, steps, support.rotation)

    def _step_context(
        self, support: Support, step: StepProblem | None, adjusted: StepBounds | None, free: tuple[bool, bool]
    ) -> StepContext:
        execution, here, left, transfer = self._execution, None, 0.0, 0.0
        increment, side = self._increments(support)
        if step is not None and execution.phase.kind is PhaseKind.SINGLE:
            double = execution.schedule.step(execution.phase.step).double
            here, left, transfer = step.swing[0], execution.time_left, double * self.parameters.sample_time
        bounds = self._recovery.bounds(increment, free, here, left, adjusted)
        return StepContext(increment, (side, -side), free, here, left, transfer, *bounds)

    def _increments(self, support: Support) -> tuple[Array, float]:
        """Displacements of the next two footsteps, shape (2, 2) [m], and side of the first."""
        landed, schedule, increment = self._execution.landed, self._execution.schedule, np.zeros((2, 2))
        places = schedule.positions[schedule.index(landed) :][:3, :2]
        ahead = (places[1:] - places[:-1]) @ support.rotation
        increment[: len(ahead)] = ahead
        return increment, schedule.step(landed).place.foot.other.side

    def _status(self, motion: Motion, balance: Balance) -> PlanStatus:
        age, told = 0, self._plan is not None and self._plan.status.falling
        if motion.solver is SolverStatus.HELD:
            age = (self._plan.status.age if self._plan is not None else 0) + 1
        return PlanStatus(
            solver=motion.solver,
            zmp_slack=motion.zmp_slack,
            terminal_slack=motion.terminal_slack,
            infeasible=motion.infeasible,
            age=age,
            late_touchdown=self._execution.waited,
            early_touchdown=self._execution.early,
            falling=(told or balance.lost > 0) and falling(balance, told, self.parameters.recovery),
        )
