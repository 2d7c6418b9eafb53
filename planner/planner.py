"""The walking planner: the four modules of the paper, put together once per tick."""

import math
from dataclasses import dataclass, fields, replace

import numpy as np

from surefoot.errors import ParameterError
from surefoot.planner.check import check_durations
from surefoot.planner.geometry import sole_pose, wrap_angle
from surefoot.planner.ground.terrain import Terrain, flat
from surefoot.planner.laws.constraints import StepContext
from surefoot.planner.laws.law import Motion, MotionProblem
from surefoot.planner.laws.profiles import PROFILES, Profile
from surefoot.planner.model.jerk import Trajectory, block_moves, predict, trajectory
from surefoot.planner.parameters import PlannerParameters
from surefoot.planner.plan import WalkPlan
from surefoot.planner.references.com_height import (
    HeightProfile,
    SmoothHeight,
    check_height,
)
from surefoot.planner.references.window import OffsetTable, Outlook, Window
from surefoot.planner.references.zmp_reference import Support, present_support
from surefoot.planner.swing.heel_off import FootRoll
from surefoot.planner.swing.trajectory import SwingTrajectory, start_swing, swing_times
from surefoot.planner.types import (
    Array,
    CentroidalState,
    FeetState,
    Foot,
    PlannedFootstep,
    PlanStatus,
    SolverStatus,
)
from surefoot.planner.walk.clock import Stepper
from surefoot.planner.walk.commands import Command, Orders, Twist
from surefoot.planner.walk.footsteps import FootstepPlan
from surefoot.planner.walk.gait import GaitParameters
from surefoot.planner.walk.queue import Ground, StepQueue
from surefoot.planner.walk.reach import StepRegion
from surefoot.planner.walk.source import CommandSource


@dataclass(frozen=True, slots=True)
class Decided:
    """What a tick has decided.

    Attributes:
        motion: predicted motion in the plan frame.
        shifts: shifts of the next two footsteps in the plan frame, shape (2, 2) [m].
        footsteps: the next footsteps.
        swing: trajectory of the swing foot.
        roll: of the foot that leaves the ground.
        status: how it came about.
    """

    motion: Trajectory
    shifts: Array
    footsteps: tuple[PlannedFootstep, ...]
    swing: SwingTrajectory | None
    roll: FootRoll | None
    status: PlanStatus


def world_plan(time: float, stepper: Stepper, support: Support, window: Window, decided: Decided) -> WalkPlan:
    """The plan of a tick.

    Args:
        time: instant of the measurement [s].
        stepper: clock and footholds.
        support: the present support and the plan frame on it.
        window: references.
        decided: motion and footsteps.
    """
    motion, reference = decided.motion, window.reference
    count, to_world = len(motion.zmp), support.rotation.T
    com = np.empty((3, count, 3))
    com[:, :, :2] = motion.com @ to_world
    com[0, :, :2] += support.origin
    com[:, :, 2] = window.height.height[:, :count]
    point = reference.point[:count] + reference.gain[:count] @ decided.shifts
    return WalkPlan(
        time=time,
        sample_time=stepper.sample_time,
        com=com[0],
        com_velocity=com[1],
        com_acceleration=com[2],
        jerk=motion.jerk @ to_world,
        zmp=(motion.zmp + window.offset[:count]) @ to_world + support.origin,
        zmp_offset=window.offset[:count] @ to_world,
        zmp_reference=point @ to_world + support.origin,
        stiffness=window.stiffness[:count],
        omega=window.omega[:count],
        phase=stepper.info,
        contacts=window.contacts[:count],
        load_left=window.load_left[:count],
        support_polygon=support.outer,
        inner_polygon=support.inner,
        footholds=support.footholds,
        footsteps=decided.footsteps,
        swing=decided.swing,
        roll=decided.roll,
        status=decided.status,
    )


_SAME_TARGET = 1e-4
"""Difference of touchdown pose that is not worth a new swing trajectory [m, rad]."""


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
    ) -> None:
        self.gait = gait
        self.parameters = parameters or profile.parameters
        p = self.parameters
        terrain = terrain or flat()
        for name, size in (("foot_length", foot_length), ("foot_width", foot_width)):
            if not (size > 0.0 and math.isfinite(size)):
                raise ParameterError((name,), f"{name} is {size:g}", "it must be a finite number greater than 0")
        self._half_size = 0.5 * np.array([foot_length, foot_width])
        profile_height = height_profile or profile.height or SmoothHeight()
        self._outlook = Outlook(
            gait, profile_height, p.leg, float(self._half_size[0]), p.horizon + p.preview + 1, p.sample_time
        )
        queue = StepQueue(gait, feet, Ground(terrain, self._half_size, p))
        self._stepper = Stepper(queue, terrain, p, self._outlook.reach + 1)
        check_height(profile_height, gait, self._stepper.samples(self._outlook.reach), queue.support_heights)
        self._prediction = predict(p.sample_time, block_moves((0,), p.horizon))
        self._law = profile.law(p, profile_height.standing(gait))
        self._support: Support | None = None
        self._offsets: OffsetTable | None = None
        self._swing: SwingTrajectory | None = None
        self._plan: WalkPlan | None = None
        region = region or StepRegion(p.reach_length, p.reach_width, (foot_length, foot_width))
        self._source, self._takes_commands = CommandSource(gait, region), not terrain.has_edges
        self._command: Command | None = None
        self.motion: Motion | None = None

    @property
    def footsteps(self) -> FootstepPlan:
        """Footholds in sight: landed ones as measured, the others as nominally planned from them."""
        return self._stepper.footsteps

    @property
    def orders(self) -> Orders:
        """What the walk does of what it has been told."""
        source, gait = self._source, self._stepper.queue.gait
        place = source.places[-1] if source.places else None
        durations = gait.single_support, gait.double_support
        return Orders(source.twist, source.followed(gait.period), place, *durations, gait.swing_height)

    def command(self, command: Command) -> None:
        """Do something else from the next plan on; of two commands before it the later one holds.

        A step that is being swung, or to which the weight is being shifted, is taken as it was planned. What is left of
        the present phase changes in proportion to its duration.

        Args:
            command: what changes.

        Raises:
            ParameterError: the ground has edges, on which footsteps would have to keep to treads, or the CoM would fall
                almost freely in phases that short.
        """
        if not self._takes_commands and (command.twist or command.places):
            what = "a velocity or a place to go to on ground with edges, whose treads the footsteps would not keep to"
            raise ParameterError(("command",), what, "command a walk on bare ground")
        given = {entry.name: getattr(command, entry.name) for entry in fields(command)}
        given = {name: value for name, value in given.items() if value is not None}
        before = self._command or Command()
        if "twist" in given or "places" in given:
            before = replace(before, twist=None, places=None)
        command = replace(before, **given)
        check_durations(self._commanded_gait(command), self.parameters.sample_time)
        self._command = command

    def _commanded_gait(self, command: Command) -> GaitParameters:
        """The gait of the steps to come with what a command changes of it."""
        changed = {name: getattr(command, name) for name in ("single_support", "double_support", "swing_height")}
        given = {name: value for name, value in changed.items() if value is not None}
        return replace(self._stepper.queue.gait, **given)

    def _obey(self, command: Command, time: float) -> None:
        """Do what has been commanded since the last plan."""
        stepper, gait = self._stepper, self._commanded_gait(command)
        before = stepper.queue.gait
        if (gait.single_support, gait.double_support) != (before.single_support, before.double_support):
            delay = stepper.retime(gait)
            if self._swing is not None and stepper.swing_foot is not None and delay:
                self._swing = self._swing.retimed(time, delay, self.parameters.sample_time)
        stepper.queue.gait = gait
        if command.twist is not None or command.places is not None:
            self._source.twist, self._source.places = command.twist or Twist(), command.places or ()
            stepper.reorder(self._source)
        elif gait.swing_height != before.swing_height:
            stepper.reorder()

    def update(self, state: CentroidalState, feet: FeetState) -> WalkPlan:
        """Plan from a measurement; call it once per sample time.

        Args:
            state: measured CoM.
            feet: measured feet.

        Raises:
            ValueError: the measured CoM or feet are not finite.
        """
        if not math.isfinite(float(state.com.sum() + state.com_velocity.sum() + feet.position.sum() + feet.yaw.sum())):
            raise ValueError(f"The measured CoM or feet are not finite at {state.time:g} s.")
        p, stepper = self.parameters, self._stepper
        stepper.advance(feet)
        if self._command is not None:
            self._obey(self._command, state.time)
            self._command = None
        self._fix_imminent_footstep(state.time)
        # ZMP planner: what carries the robot now, and the ZMP that the footsteps define.
        support = self._support = present_support(self._support, stepper, self._half_size, p.foot_margin)
        samples = stepper.samples(self._outlook.reach)
        reference = self._outlook.zmp(samples, support)
        # Vertical motion planner of the CoM, with it the varying dynamics.
        height = self._outlook.com_height(samples, support, reference)
        local = self._local_state(state, support)
        window = self._outlook.window(stepper, samples, support, reference, height, local[:, 0], self._offsets)
        self._offsets = window.table
        # Online constraints generator: the box comes with the reference, the reach of the feet here.
        problem = self._problem(local, feet, support, window)
        # TVMPC, or the law that stands in its place.
        motion = self.motion = self._law.plan(problem)
        decided = self._decide(state.time, feet, support, window, problem, motion)
        self._plan = world_plan(state.time, stepper, support, window, decided)
        return self._plan

    def _decide(
        self, time: float, feet: FeetState, support: Support, window: Window, problem: MotionProblem, motion: Motion
    ) -> Decided:
        """Footsteps, swing and CoM that follow from the law's motion."""
        footsteps = self._stepper.upcoming(time, motion.shifts @ support.rotation.T)
        self._update_swing(time, feet, footsteps, motion.solver)
        stiffness = window.stiffness[: self.parameters.horizon + 1]
        moving = trajectory(self._prediction, problem.state, stiffness, motion.jerk)
        status = self._status(motion)
        return Decided(moving, motion.shifts, footsteps, self._swing, self._roll(time), status)

    def _problem(self, local: Array, feet: FeetState, support: Support, window: Window) -> MotionProblem:
        jerk = np.zeros((self.parameters.horizon + 1, 2))
        if self._plan is not None:
            jerk[:-1] = self._plan.jerk @ support.rotation
        return MotionProblem(
            state=local,
            stiffness=window.stiffness,
            omega=window.omega,
            reference=window.driving,
            steps=self._step_context(support, feet),
            last_jerk=jerk[0],
            fallback=jerk[1:],
            rotation=support.rotation,
        )

    def _fix_imminent_footstep(self, time: float) -> None:
        stepper, swing = self._stepper, self._swing
        if swing is None or stepper.swing_foot is None or stepper.fixed:
            return
        if swing.touchdown_time - time <= self.parameters.freeze_time + 1e-9:
            stepper.fix(swing.target[:3])

    def _step_context(self, support: Support, feet: FeetState) -> StepContext:
        stepper, steps = self._stepper, self._stepper.footsteps
        row, swing = stepper.row, stepper.swing_foot
        increment = np.zeros((2, 2))
        ahead = np.diff(steps.position[row : row + 3, :2], axis=0) @ support.rotation
        increment[: len(ahead)] = ahead
        side = 1.0 if steps.feet[row] is Foot.RIGHT else -1.0
        here = None if swing is None else (feet.position[swing, :2] - support.origin) @ support.rotation
        left = 0.0 if swing is None else stepper.time_left
        return StepContext(increment, (side, -side), stepper.free, here, left, stepper.transfer_time)

    def _local_state(self, state: CentroidalState, support: Support) -> Array:
        """Position and velocity as measured, acceleration as the last plan had it for now."""
        local = np.empty((3, 2))
        local[0] = state.com[:2] - support.origin
        local[1] = state.com_velocity[:2]
        local[2] = self._plan.com_acceleration[1, :2] if self._plan is not None else 0.0
        return np.ascontiguousarray((local @ support.rotation).T)

    def _update_swing(
        self, time: float, feet: FeetState, footsteps: tuple[PlannedFootstep, ...], solver: SolverStatus
    ) -> None:
        stepper, foot = self._stepper, self._stepper.swing_foot
        if foot is None:
            self._swing = None
            return
        following = footsteps[0].footstep
        target = sole_pose(following.position, following.yaw, following.normal)
        if self._swing is None:
            yaw = float(stepper.footsteps.yaw[stepper.row - 1])
            yaw += wrap_angle(float(feet.yaw[foot]) - yaw)
            pose = sole_pose(feet.position[foot], yaw, stepper.footsteps.normal[stepper.row - 1])
            course = stepper.swinging.course
            times = swing_times(time, stepper.left, course, self.parameters)
            self._swing = start_swing(foot, pose, target, times, course.height, self.parameters)
            return
        decided = stepper.fixed or solver is SolverStatus.HELD
        if not decided and np.abs(target - self._swing.target).max() > _SAME_TARGET:
            self._swing = self._swing.retargeted(time, target)

    def _roll(self, time: float) -> FootRoll | None:
        stepper, t = self._stepper, self.parameters.sample_time
        span = stepper.phase.roll
        if span is None or stepper.tick >= span.end:
            return None
        foot = self.gait.step_foot(stepper.phase.row)
        start, end = (time + (at - stepper.tick) * t for at in span[:2])
        return FootRoll(foot, start, end, span.angle, float(self._half_size[0]), stepper.hurry(time))

    def _status(self, motion: Motion) -> PlanStatus:
        age = 0
        if motion.solver is SolverStatus.HELD:
            age = (self._plan.status.age if self._plan is not None else 0) + 1
        return PlanStatus(
            solver=motion.solver,
            zmp_slack=motion.zmp_slack,
            terminal_slack=motion.terminal_slack,
            infeasible=motion.infeasible,
            age=age,
            late_touchdown=self._stepper.waited,
            early_touchdown=self._stepper.early,
        )
