"""The walking planner: the four modules of the paper, put together once per tick."""

import math
from dataclasses import dataclass

import numpy as np

from planner.com_height import HeightProfile, SmoothHeight, preview_height
from planner.constraints import StepContext, generate_constraints, reach_box
from planner.dcm import natural_frequency
from planner.footsteps import FootstepPlan, plan_footsteps, wrap_angle
from planner.gait import GaitParameters
from planner.moves import block_moves
from planner.parameters import PlannerParameters
from planner.plan import WalkPlan
from planner.polygon import convex_hull, sole_corners
from planner.prediction import predict
from planner.qp import solve
from planner.schedule import schedule
from planner.stepper import Stepper
from planner.swing import SwingTrajectory, start_swing
from planner.terrain import Terrain, flat
from planner.tvmpc import TvmpcProblem, build_problem, trajectory
from planner.types import (
    Array,
    CentroidalState,
    FeetState,
    Foot,
    Footstep,
    PhaseKind,
    PlannedFootstep,
    PlanStatus,
    SolverStatus,
)
from planner.zmp_reference import SupportTable, frame_rotation, support_table, zmp_reference


@dataclass(frozen=True, slots=True)
class _Support:
    """What changes only with the phase and the footholds."""

    key: tuple[object, ...]
    rotation: Array
    origin: Array
    table: SupportTable
    heights: Array
    outer: Array
    inner: Array
    footholds: tuple[Footstep, Footstep]


@dataclass(frozen=True, slots=True)
class _Solution:
    """Both axes' optimum in the plan frame."""

    jerk: Array
    shifts: Array
    zmp_slack: Array
    terminal_slack: Array
    solver: SolverStatus


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

    Raises:
        ValueError: a duration is no multiple of the sample time, or a footstep is out of reach.
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
        self._terrain = terrain
        self._half_size = 0.5 * np.array([foot_length, foot_width])
        self.schedule = schedule(gait, p.sample_time, p.horizon + p.preview)
        footsteps = plan_footsteps(gait, feet, terrain)
        _check_reach(footsteps, p)
        self._stepper = Stepper(self.schedule, footsteps, terrain, p)
        self._shape = (height_profile or SmoothHeight()).shape(gait, self.schedule)
        self._prediction = predict(p.sample_time, block_moves(p.moves, p.horizon))
        self._support: _Support | None = None
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
            ValueError: the measured CoM is not finite.
        """
        if not math.isfinite(float(state.com.sum() + state.com_velocity.sum())):
            raise ValueError(f"The measured CoM is not finite at {state.time:g} s.")
        p, stepper = self.parameters, self._stepper
        stepper.advance(feet)
        self._fix_late_footstep(state.time)
        support = self._refresh_support()
        count, n = p.horizon + p.preview + 1, p.horizon
        reference = zmp_reference(self.schedule, support.table, stepper.sample, count)
        height = preview_height(self._shape, stepper.sample, count, support.heights, reference.height)
        omega = natural_frequency(height.stiffness, p.sample_time)
        constraints = generate_constraints(p, reference, height.stiffness, omega, self._step_context(support, feet))
        self.problem = build_problem(
            p, self._prediction, self._local_state(state, support), height.stiffness[: n + 1], reference, constraints,
            self._last_jerk(support),
        )
        solution = self._solve(self.problem, support)
        motion = trajectory(self._prediction, self.problem, solution.jerk)
        footsteps = self._next_footsteps(state.time, support, solution)
        self._update_swing(state.time, feet, footsteps, solution)
        to_world = support.rotation.T
        com = np.empty((3, n + 1, 3))
        com[:, :, :2] = motion.com @ to_world
        com[0, :, :2] += support.origin
        com[:, :, 2] = height.height[:, : n + 1]
        point = reference.point[: n + 1] + reference.gain[: n + 1] @ solution.shifts
        window = slice(stepper.sample, stepper.sample + n + 1)
        self._plan = WalkPlan(
            time=state.time,
            sample_time=p.sample_time,
            com=com[0],
            com_velocity=com[1],
            com_acceleration=com[2],
            jerk=motion.jerk @ to_world,
            zmp=motion.zmp @ to_world + support.origin,
            zmp_reference=point @ to_world + support.origin,
            zmp_height=reference.height[: n + 1],
            stiffness=height.stiffness[: n + 1],
            omega=omega[: n + 1],
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
        return self._plan

    def _fix_late_footstep(self, time: float) -> None:
        stepper, swing = self._stepper, self._swing
        if swing is None or stepper.swing_foot is None or stepper.fixed:
            return
        if swing.touchdown_time - time <= self.parameters.freeze_time + 1e-9:
            stepper.fix(swing.target[:3])

    def _refresh_support(self) -> _Support:
        stepper = self._stepper
        steps, row, phase = stepper.footsteps, stepper.row, stepper.phase
        key = (steps, row, phase.start, stepper.free)
        if self._support is not None and all(a is b or a == b for a, b in zip(key[1:], self._support.key[1:], strict=True)):
            if self._support.key[0] is steps:
                return self._support
        latest, before = steps.footstep(row), steps.footstep(row - 1)
        standing = [latest] if phase.kind is PhaseKind.SINGLE else [latest, before]
        margin = self.parameters.foot_margin
        outer, inner = (
            convex_hull(np.concatenate([sole_corners(f, scale * self._half_size) for f in standing]))
            for scale in (1.0, margin)
        )
        self._support = _Support(
            key=key,
            rotation=frame_rotation(latest.yaw),
            origin=latest.position[:2],
            table=support_table(steps, row, stepper.free, margin * self._half_size),
            heights=steps.support_points()[:, 2],
            outer=outer,
            inner=inner,
            footholds=(latest, before) if latest.foot is Foot.LEFT else (before, latest),
        )
        return self._support

    def _step_context(self, support: _Support, feet: FeetState) -> StepContext:
        stepper, steps = self._stepper, self._stepper.footsteps
        row, swing = stepper.row, stepper.swing_foot
        increment = np.zeros((2, 2))
        ahead = np.diff(steps.position[row : row + 3, :2], axis=0) @ support.rotation
        increment[: len(ahead)] = ahead
        side = 1.0 if steps.feet[row].other is Foot.LEFT else -1.0
        here = None if swing is None else (feet.position[swing, :2] - support.origin) @ support.rotation
        left = 0.0 if swing is None else stepper.time_to_touchdown(stepper.phase.step)
        return StepContext(increment, (side, -side), stepper.free, here, left)

    def _local_state(self, state: CentroidalState, support: _Support) -> Array:
        local = np.empty((3, 2))
        local[0] = state.com[:2] - support.origin
        local[1] = state.com_velocity[:2]
        local[2] = self._plan.com_acceleration[1, :2] if self._plan is not None else 0.0
        return np.ascontiguousarray((local @ support.rotation).T)

    def _last_jerk(self, support: _Support) -> Array:
        return self._plan.jerk[0] @ support.rotation if self._plan is not None else np.zeros(2)

    def _solve(self, problem: TvmpcProblem, support: _Support) -> _Solution:
        basis = self._prediction.basis
        n, m = basis.shape
        jerk, shifts = np.zeros((n, 2)), np.zeros((2, 2))
        slack = np.full((2, 2), np.nan)
        worst = SolverStatus.SOLVED
        for axis, qp in enumerate(problem.axes):
            solution = solve(qp, self.parameters.solvers)
            worst = max(worst, SolverStatus(solution.attempt))
            if solution.z is not None:
                jerk[:, axis] = basis @ solution.z[:m]
                shifts[:, axis], slack[:, axis] = solution.z[m : m + 2], solution.z[m + 2 :]
            elif self._plan is not None:
                jerk[:-1, axis] = self._plan.jerk[1:] @ support.rotation[:, axis]
        return _Solution(jerk, shifts, slack[0], slack[1], worst)

    def _next_footsteps(self, time: float, support: _Support, solution: _Solution) -> tuple[PlannedFootstep, ...]:
        stepper, steps = self._stepper, self._stepper.footsteps
        shift = solution.shifts * np.array(stepper.free)[:, None] @ support.rotation.T
        planned = []
        for ahead, row in enumerate(range(stepper.row + 1, min(stepper.row + 4, steps.steps + 2))):
            position = steps.position[row].copy()
            position[:2] += shift[: ahead + 1].sum(axis=0)
            if np.abs(position[:2] - steps.position[row, :2]).max() > 1e-3:
                position[2] = self._terrain.height(float(position[0]), float(position[1]))
            footstep = Footstep(steps.feet[row], position, float(steps.yaw[row]))
            planned.append(PlannedFootstep(row - 1, footstep, time + stepper.time_to_touchdown(row - 1)))
        return tuple(planned)

    def _update_swing(
        self, time: float, feet: FeetState, footsteps: tuple[PlannedFootstep, ...], solution: _Solution
    ) -> None:
        stepper, phase, foot = self._stepper, self._stepper.phase, self._stepper.swing_foot
        if foot is None:
            self._swing = None
            return
        target = np.append(footsteps[0].footstep.position, footsteps[0].footstep.yaw)
        if self._swing is None:
            t = self.parameters.sample_time
            yaw = stepper.footsteps.yaw[stepper.row - 1]
            pose = np.append(feet.position[foot], yaw + wrap_angle(float(feet.yaw[foot] - yaw)))
            times = (time, time + phase.samples // 2 * t, time + phase.samples * t)
            self._swing = start_swing(foot, pose, target, times, self.gait.swing_height, self.parameters)
        elif not stepper.fixed and solution.solver is not SolverStatus.HELD:
            self._swing = self._swing.retargeted(time, target)

    def _status(self, solution: _Solution) -> PlanStatus:
        held = solution.solver is SolverStatus.HELD
        age = (self._plan.status.age if self._plan is not None else 0) + 1 if held else 0
        stepper = self._stepper
        return PlanStatus(
            solution.solver, solution.zmp_slack, solution.terminal_slack, age, stepper.waited, stepper.early
        )


def _check_reach(footsteps: FootstepPlan, parameters: PlannerParameters) -> None:
    for row in range(2, footsteps.steps + 2):
        step = footsteps.increment[row] @ frame_rotation(float(footsteps.yaw[row - 1]))
        lower, upper = reach_box(parameters, 1.0 if footsteps.feet[row] is Foot.LEFT else -1.0)
        if np.any(step < lower - 1e-9) or np.any(step > upper + 1e-9):
            raise ValueError(
                f"Footstep {row - 1} would land {step[0]:.3f} m ahead and {step[1]:.3f} m to the left of its stance foot,"
                f" but it must be within {lower[0]:g} to {upper[0]:g} m ahead and {lower[1]:g} to {upper[1]:g} m to the left."
            )
