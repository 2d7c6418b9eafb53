"""The walking planner: the four modules of the paper, put together once per tick."""

import math
from dataclasses import dataclass, replace

import numpy as np

from planner.com_height import HeightPreview, HeightProfile, SmoothHeight, check_height, preview_height
from planner.constraints import StepContext, check_reach, generate_constraints
from planner.dcm import natural_frequency
from planner.footsteps import FootstepPlan, plan_footsteps
from planner.frames import wrap_angle
from planner.gait import GaitParameters
from planner.leg_inertia import softening, sole_positions, swing_shape, zmp_offset
from planner.moves import block_moves
from planner.nominal import NominalMotion, jerk_range, no_motion, nominal_motion
from planner.parameters import PlannerParameters
from planner.plan import WalkPlan
from planner.prediction import predict
from planner.schedule import schedule
from planner.solution import TvmpcSolution, solve_problem
from planner.stepper import Stepper
from planner.support import Support, present_support
from planner.swing import SwingTrajectory, start_swing, swing_times
from planner.terrain import Terrain, flat
from planner.tvmpc import Trajectory, TvmpcProblem, build_problem, trajectory
from planner.types import Array, CentroidalState, FeetState, Foot, PlannedFootstep, PlanStatus, SolverStatus
from planner.zmp_reference import ZmpReference, zmp_reference

_SAME_TARGET = 1e-4
"""Difference of touchdown pose that is not worth a new swing trajectory [m, rad]."""


@dataclass(frozen=True, slots=True)
class _Preview:
    """What is known of the window before solving."""

    reference: ZmpReference
    offset: Array
    height: HeightPreview
    stiffness: Array
    omega: Array


class WalkingPlanner:
    """Receding-horizon planner of CoM, ZMP and footsteps, from the measured state at every tick.

    It plans in a frame with origin and planned heading at the stance foot (the foot landed last in double support), so
    that its numbers do not depend on where in the world it walks, and ZMP boxes and reach boxes are aligned with it.
    CoM position and velocity come from the measurement, the acceleration from the plan before.

    Args:
        gait: the walk.
        feet: where the feet stand at the start.
        foot_length: length of the sole [m].
        foot_width: width of the sole [m].
        terrain: what the planner believes about the ground.
        parameters: the planner's own parameters.
        height_profile: vertical CoM motion.

    Attributes:
        gait: the walk.
        parameters: the planner's own parameters.
        schedule: its phases on the clock.
        problem: the QPs of the last tick, to be looked at or stored; None before the first.

    Raises:
        ValueError: a duration is no multiple of the sample time, a footstep is out of reach, or the CoM would fall
            almost freely.
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
    ) -> None:
        self.gait = gait
        self.parameters = parameters or PlannerParameters()
        p = self.parameters
        terrain = terrain or flat()
        for name, size in (("foot_length", foot_length), ("foot_width", foot_width)):
            if not (size > 0.0 and math.isfinite(size)):
                raise ValueError(f"{name} is {size}, but it must be a finite number greater than 0.")
        self._half_size = 0.5 * np.array([foot_length, foot_width])
        self.schedule = schedule(gait, p.sample_time, p.horizon + p.preview)
        footsteps = plan_footsteps(gait, feet, terrain)
        check_reach(footsteps, p)
        self._stepper = Stepper(self.schedule, footsteps, terrain, p)
        self._shape = (height_profile or SmoothHeight()).shape(gait, self.schedule)
        check_height(self._shape, self.schedule, footsteps.support_points()[:, 2])
        self._swing_shape = swing_shape(gait, self.schedule, p)
        self._prediction = predict(p.sample_time, block_moves(p.moves, p.horizon))
        self._support: Support | None = None
        self._swing: SwingTrajectory | None = None
        self._plan: WalkPlan | None = None
        self.problem: TvmpcProblem | None = None

    @property
    def footsteps(self) -> FootstepPlan:
        """All footholds: landed ones as measured, the others as nominally planned from them."""
        return self._stepper.footsteps

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
        p, stepper, n = self.parameters, self._stepper, self.parameters.horizon
        stepper.advance(feet)
        self._fix_imminent_footstep(state.time)
        support = present_support(self._support, stepper, self._half_size, p.foot_margin)
        self._support = support
        window = (stepper.sample, n + p.preview + 1)
        reference = zmp_reference(self.schedule, support.table, *window)
        height = preview_height(self._shape, *window, support.heights, reference.height)
        local = self._local_state(state, support)
        offset = self._leg_offset(support, local[:, 0], reference.point, height)
        driving = replace(reference, point=reference.point - offset)
        stiffness = softening(p.leg) * height.stiffness
        omega = natural_frequency(stiffness, p.sample_time)
        steps = self._step_context(support, feet)
        nominal = self._nominal(local[:, 0], driving.point, stiffness)
        rest = replace(driving, point=driving.point - nominal.zmp)
        self.problem = build_problem(
            p,
            self._prediction,
            local - nominal.com[:, 0].T,
            stiffness[: n + 1],
            rest,
            generate_constraints(p, rest, stiffness, omega, steps),
            self._local_jerk(support)[0] - nominal.jerk[0],
            jerk_range(nominal.jerk[:n], p.moves, p.jerk_limit),
        )
        solution = solve_problem(
            self.problem, self._prediction, p.solvers, self._shifted_jerk(support) - nominal.jerk[:n]
        )
        footsteps = stepper.upcoming(state.time, solution.shifts @ support.rotation.T)
        self._update_swing(state.time, feet, footsteps, solution)
        motion = trajectory(self._prediction, self.problem, solution.jerk)
        motion = Trajectory(
            motion.com + nominal.com[:, : n + 1], motion.zmp + nominal.zmp[: n + 1], motion.jerk + nominal.jerk[:n]
        )
        preview = _Preview(reference, offset, height, stiffness, omega)
        self._plan = self._world_plan(state.time, support, preview, motion, solution, footsteps)
        return self._plan

    def _nominal(self, position: Array, zmp: Array, stiffness: Array) -> NominalMotion:
        """The motion that the moves are added to; with a limit on the jerk's rate they are the whole motion."""
        t = self.parameters.sample_time
        if math.isfinite(self.parameters.jerk_rate_limit):
            return no_motion(len(zmp), t)
        return nominal_motion(position, zmp, stiffness, t)

    def _leg_offset(self, support: Support, position: Array, reference: Array, height: HeightPreview) -> Array:
        """ZMP offset of the legs' motion over the window, shape (n, 2) [m], for a CoM near the nominal motion."""
        p, offset = self.parameters, np.zeros_like(reference)
        chain, softened = p.leg.chain, softening(p.leg) * height.stiffness
        if chain is None:
            return offset
        samples = np.maximum(self._stepper.sample + np.arange(-1, len(reference)), 0)
        frame = (support.rotation, support.origin)
        soles, heading = sole_positions(self._swing_shape, self._stepper.footsteps, frame, samples)
        for _ in range(2):
            motion = nominal_motion(position, reference - offset, softened, p.sample_time)
            offset = zmp_offset(chain, soles, heading, motion, height, softened)
        return offset

    def _world_plan(
        self,
        time: float,
        support: Support,
        preview: _Preview,
        motion: Trajectory,
        solution: TvmpcSolution,
        footsteps: tuple[PlannedFootstep, ...],
    ) -> WalkPlan:
        stepper, reference, height = self._stepper, preview.reference, preview.height
        count, to_world = self.parameters.horizon + 1, support.rotation.T
        com = np.empty((3, count, 3))
        com[:, :, :2] = motion.com @ to_world
        com[0, :, :2] += support.origin
        com[:, :, 2] = height.height[:, :count]
        point = reference.point[:count] + reference.gain[:count] @ solution.shifts
        window = slice(stepper.sample, stepper.sample + count)
        return WalkPlan(
            time=time,
            sample_time=self.parameters.sample_time,
            com=com[0],
            com_velocity=com[1],
            com_acceleration=com[2],
            jerk=motion.jerk @ to_world,
            zmp=(motion.zmp + preview.offset[:count]) @ to_world + support.origin,
            zmp_offset=preview.offset[:count] @ to_world,
            zmp_reference=point @ to_world + support.origin,
            stiffness=preview.stiffness[:count],
            omega=preview.omega[:count],
            phase=stepper.info,
            contacts=self.schedule.contacts[window],
            load_left=self.schedule.load_left[window],
            support_polygon=support.outer,
            inner_polygon=support.inner,
            footholds=support.footholds,
            footsteps=footsteps,
            swing=self._swing,
            status=self._status(solution),
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
        left = 0.0 if swing is None else stepper.time_to_touchdown(stepper.phase.step)
        return StepContext(increment, (side, -side), stepper.free, here, left)

    def _local_state(self, state: CentroidalState, support: Support) -> Array:
        """Position and velocity as measured, acceleration as the last plan had it for now."""
        local = np.empty((3, 2))
        local[0] = state.com[:2] - support.origin
        local[1] = state.com_velocity[:2]
        local[2] = self._plan.com_acceleration[1, :2] if self._plan is not None else 0.0
        return np.ascontiguousarray((local @ support.rotation).T)

    def _local_jerk(self, support: Support) -> Array:
        if self._plan is None:
            return np.zeros((self.parameters.horizon, 2))
        return self._plan.jerk @ support.rotation

    def _shifted_jerk(self, support: Support) -> Array:
        jerk = np.zeros((self.parameters.horizon, 2))
        jerk[:-1] = self._local_jerk(support)[1:]
        return jerk

    def _update_swing(
        self, time: float, feet: FeetState, footsteps: tuple[PlannedFootstep, ...], solution: TvmpcSolution
    ) -> None:
        stepper, phase, foot = self._stepper, self._stepper.phase, self._stepper.swing_foot
        if foot is None:
            self._swing = None
            return
        target = np.append(footsteps[0].footstep.position, footsteps[0].footstep.yaw)
        if self._swing is None:
            yaw = float(stepper.footsteps.yaw[stepper.row - 1])
            pose = np.append(feet.position[foot], yaw + wrap_angle(float(feet.yaw[foot]) - yaw))
            times = swing_times(time, phase.samples, self.parameters)
            self._swing = start_swing(foot, pose, target, times, self.gait.swing_height, self.parameters)
            return
        decided = stepper.fixed or solution.solver is SolverStatus.HELD
        if not decided and np.abs(target - self._swing.target).max() > _SAME_TARGET:
            self._swing = self._swing.retargeted(time, target)

    def _status(self, solution: TvmpcSolution) -> PlanStatus:
        held = solution.solver is SolverStatus.HELD
        age = (self._plan.status.age if self._plan is not None else 0) + 1 if held else 0
        waited, early = self._stepper.waited, self._stepper.early
        return PlanStatus(solution.solver, solution.zmp_slack, solution.terminal_slack, age, waited, early)
