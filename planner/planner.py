"""The walking planner: the four modules of the paper, put together once per tick."""

import math
from dataclasses import replace

import numpy as np

from surefoot.errors import ParameterError
from surefoot.planner.check import check_durations, check_height
from surefoot.planner.flight import swinging_to, upcoming
from surefoot.planner.ground.terrain import Terrain, flat
from surefoot.planner.laws.law import Motion
from surefoot.planner.laws.names import PROFILES
from surefoot.planner.laws.profiles import Profile
from surefoot.planner.look import View, look
from surefoot.planner.measured import Measured
from surefoot.planner.parameters import PlannerParameters
from surefoot.planner.pelvis import swaying
from surefoot.planner.plan.plan import WalkPlan
from surefoot.planner.problem import problem_of
from surefoot.planner.recovery.falling import falling
from surefoot.planner.references.com_height import HeightProfile, SmoothHeight
from surefoot.planner.rules import gone_through
from surefoot.planner.state import Orders, SwingStage, WalkState
from surefoot.planner.steps.commands import STANDING, Command
from surefoot.planner.steps.gait import GaitParameters
from surefoot.planner.steps.schedule import Schedule
from surefoot.planner.steps.source import CommandSource
from surefoot.planner.swing.course import Ground
from surefoot.planner.swing.leg_reach import LegReach
from surefoot.planner.swing.step_region import StepRegion
from surefoot.planner.track import track
from surefoot.planner.types import Balance, CentroidalState, FeetState, Footstep, PlanStatus, SolverStatus
from surefoot.planner.walk_model import WalkModel


class WalkingPlanner:
    """Receding-horizon planner of CoM, ZMP and footsteps, from the measured state at every tick.

    It plans in a frame at the stance foot, or at the foot that landed last in double support, with its planned heading.
    So its numbers do not depend on the place in the world, and ZMP boxes and reach boxes are aligned with the frame.
    CoM position and velocity come from the measurement, the acceleration from the plan before. How the CoM moves is the
    profile's law of motion (see `planner.laws.profiles`); all else is common to the profiles.

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
        legs: their reach to catch the body. With None the law alone moves steps, as the parameters let it, and
            recovery neither adds nor retimes any.

    Attributes:
        gait: the walk.
        parameters: the planner's own parameters.
        state: of the walk, a value; a plan makes the next one of it.
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
        ground = Ground(terrain, 0.5 * np.array([foot_length, foot_width]), p)
        heights = height_profile or profile.height or SmoothHeight()
        legs = legs.adapting(p) if legs is not None and profile.catches else None
        model = WalkModel.of(gait, ground, heights, legs)
        self.state = WalkState.start(model, feet)
        points = self.state.schedule.support_points[:, 2]
        check_height(heights, gait, self.state.samples(model.reach), points)
        self._rules, self._law = profile.rules, profile.law(p, heights.standing(gait))
        region = region or StepRegion(p.reach_length, p.reach_width, (foot_length, foot_width), p.recovery.sole_gap)
        self._region, self._bare = region, not terrain.has_edges
        self.motion: Motion | None = None

    @property
    def schedule(self) -> Schedule:
        """The steps in sight: landed ones as measured, the others as nominally planned from them."""
        return self.state.schedule

    @property
    def orders(self) -> Command:
        """Commands that the walk follows now, with the velocity that it follows."""
        source, gait = self.state.orders.source, self.state.schedule.gait
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
        orders = self.state.orders
        gait, commanded = orders.new or (self.state.schedule.gait, None)
        gait = replace(gait, **{name: value for name, value in changed.items() if value is not None})
        check_durations(gait, self.parameters.sample_time)
        # Steps of a source that is kept are asked for anew, too: their strides follow from the durations.
        source = commanded or orders.source
        if command.twist is not None or command.places is not None or command.march:
            size, twist = self.parameters.size, command.twist or STANDING
            source = CommandSource(self.gait, self._region, twist, command.places or (), size, command.march)
        self.state = replace(self.state, orders=Orders(orders.source, (gait, source)))

    def update(self, state: CentroidalState, feet: FeetState) -> WalkPlan:
        """Plan from a measurement; call it once per sample time.

        Args:
            state: measured CoM.
            feet: measured feet.

        Raises:
            ValueError: the measured CoM or feet are not finite.
        """
        measured = Measured(state, feet)
        view, acted = gone_through(self._rules, look(track(self.state, measured), measured))
        # TVMPC, or the law that stands in its place.
        self.motion = self._law.plan(problem_of(view))
        self.state, plan = planned(view, self.motion, acted)
        return plan


def planned(view: View, motion: Motion, acted: tuple[str, ...]) -> tuple[WalkState, WalkPlan]:
    """The state whose swing foot goes where a motion has its step land, and the plan of the tick in the world frame.

    Args:
        view: of the tick, that rules have gone through.
        motion: the law's.
        acted: names of the rules that made something.
    """
    state, support, measured = view.state, view.support, view.measured
    shifts = motion.shifts @ support.rotation.T if any(motion.shifts.ravel().tolist()) else np.zeros((2, 2))
    footsteps = upcoming(state, measured.time, shifts)
    balance, catching = view.balance, state.catching
    if state.free[0] or catching:
        shift = shifts[0] if state.free[0] else balance.shift
        balance = replace(balance, shift=shift, catching=catching)
    if state.phase.swing_foot is not None:
        state = swinging_to(state, footsteps[0], measured, motion.solver is SolverStatus.HELD)
    plan = _world_plan(view, state, motion, footsteps, _status(state, motion, balance, acted), balance)
    law_memory = None if motion.memory is None else motion.memory @ support.rotation.T
    return replace(state, plan=plan, law_memory=law_memory), plan


def _world_plan(
    view: View, state: WalkState, motion: Motion, footsteps: tuple[Footstep, ...], status: PlanStatus, balance: Balance
) -> WalkPlan:
    """The plan of a tick, in the world frame.

    Args:
        view: of the tick.
        state: with the swing that is flown on.
        motion: the law's.
        footsteps: the next ones.
        status: of the plan.
        balance: with what the plan makes of the landing to come.
    """
    support, window, time = view.support, view.window, view.measured.time
    model, reference = state.model, window.reference
    count = model.parameters.horizon + 1
    stiffness, offset = window.stiffness[:count], window.offset[:count]
    ahead = stiffness, window.height.height[:, :count], offset, reference.point[:count], reference.gain[:count]
    com, jerk, zmp, offset, point = model.world.of(view.local, motion.jerk, motion.shifts, ahead, support.frame)
    return WalkPlan(
        time=time,
        sample_time=model.parameters.sample_time,
        com=com[0],
        com_velocity=com[1],
        com_acceleration=com[2],
        jerk=jerk,
        zmp=zmp,
        zmp_offset=offset,
        zmp_reference=point,
        stiffness=stiffness,
        omega=window.omega[:count],
        phase=state.info,
        contacts=window.contacts[:count],
        load_left=window.load_left[:count],
        support_polygon=support.outer,
        inner_polygon=support.inner,
        footholds=support.footholds,
        footsteps=footsteps,
        swing=state.swing.trajectory,
        rolls=state.rolls(time),
        status=status,
        balance=balance,
        pelvis=swaying(state, footsteps, time),
    )


def _status(state: WalkState, motion: Motion, balance: Balance, acted: tuple[str, ...]) -> PlanStatus:
    """The status of a plan."""
    last, swing, age = state.plan, state.swing, 0
    falls = last is not None and last.status.falling
    if motion.solver is SolverStatus.HELD:
        age = (0 if last is None else last.status.age) + 1
    return PlanStatus(
        solver=motion.solver,
        zmp_slack=motion.zmp_slack,
        terminal_slack=motion.terminal_slack,
        infeasible=motion.infeasible,
        age=age,
        late_touchdown=swing.waited,
        early_touchdown=swing.stage is SwingStage.LANDED,
        falling=(falls or balance.lost > 0) and falling(balance, falls, state.model.parameters.recovery),
        acted=acted,
    )
