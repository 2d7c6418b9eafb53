"""The walking planner: the four modules of the paper, put together once per tick."""

import math
from dataclasses import replace

import numpy as np

from surefoot.errors import ParameterError
from surefoot.planner.check import check_durations, check_height
from surefoot.planner.geometry import signed_distance
from surefoot.planner.ground.terrain import Terrain, flat
from surefoot.planner.laws.constraints import StepContext
from surefoot.planner.laws.law import Motion, MotionProblem
from surefoot.planner.laws.profiles import PROFILES, Profile
from surefoot.planner.margin import MOST_STEPS, Alarm, Amends, Reserve, planned_margin
from surefoot.planner.model.jerk import block_moves, predict, trajectory
from surefoot.planner.parameters import PlannerParameters, StepAdaptation
from surefoot.planner.plan import WalkPlan
from surefoot.planner.recovery import ASIDE, ASTRIDE, CALM, Catch, Recovery, Situation
from surefoot.planner.references.com_height import HeightProfile, SmoothHeight
from surefoot.planner.references.window import Outlook, Window
from surefoot.planner.references.zmp_reference import Support
from surefoot.planner.types import (
    Array,
    Balance,
    CentroidalState,
    FeetState,
    Foot,
    PhaseKind,
    PlannedFootstep,
    PlanStatus,
    SolverStatus,
)
from surefoot.planner.walk.commands import Command, Orders, Twist
from surefoot.planner.walk.footsteps import FootstepPlan
from surefoot.planner.walk.gait import GaitParameters
from surefoot.planner.walk.queue import StepQueue
from surefoot.planner.walk.reach import GAP, Legs, StepRegion
from surefoot.planner.walk.source import CommandSource
from surefoot.planner.walk.step import Ground
from surefoot.planner.walk.stepper import Stepper


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
        legs: Legs | None = None,
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
        self._outlook = Outlook(gait, heights, p, half_size)
        queue, adaptation = StepQueue(gait, feet, Ground(terrain, half_size, p)), p.step_adaptation
        legs = legs.adapting(adaptation) if legs is not None and profile.catches else None
        timing = adaptation is not StepAdaptation.LOCATION
        self._recovery = None if legs is None else Recovery(legs, p, timing)
        self._reserve = None if self._recovery is None else Reserve(self._recovery, p, half_size)
        self._amends, self._alarm = Amends(), Alarm(p.size.length)
        self._stepper = Stepper(queue, self._outlook.reach + 1, legs)
        check_height(heights, gait, self._stepper.samples(self._outlook.reach), queue.support_heights)
        self._prediction = predict(p.sample_time, block_moves((0,), p.horizon))
        self._law = profile.law(p, heights.standing(gait))
        self._plan: WalkPlan | None = None
        region = region or StepRegion(p.reach_length, p.reach_width, (foot_length, foot_width), GAP * p.size.length)
        self._region, self._bare = region, not terrain.has_edges
        self._source: CommandSource | None = None
        self._told: tuple[GaitParameters, CommandSource | None] = (gait, None)
        self.motion: Motion | None = None

    @property
    def footsteps(self) -> FootstepPlan:
        """Footholds in sight: landed ones as measured, the others as nominally planned from them."""
        return self._stepper.footsteps

    @property
    def orders(self) -> Orders:
        """What the walk does of what it has been told."""
        source, gait = self._source, self._stepper.queue.gait
        durations = gait.single_support, gait.double_support
        if source is None:
            return Orders(None, None, None, *durations, gait.swing_height)
        if source.places:
            return Orders(None, None, source.places[-1], *durations, gait.swing_height)
        return Orders(source.twist, source.followed(gait.period), None, *durations, gait.swing_height)

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
        gait = replace(self._told[0], **{name: value for name, value in changed.items() if value is not None})
        check_durations(gait, self.parameters.sample_time)
        # Steps of a source that is kept are asked for anew, too: their strides follow from the durations.
        source = self._told[1] or self._source
        if command.twist is not None or command.places is not None:
            size, twist = self.parameters.size, command.twist or Twist()
            source = CommandSource(self.gait, self._region, twist, command.places or (), size)
        self._told = gait, source

    def _obey(self, time: float) -> None:
        """Do what has been commanded since the last plan."""
        gait, source = self._told
        self._stepper.change(gait, source, time)
        self._told, self._source = (gait, None), source or self._source

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
        stepper = self._stepper
        stepper.advance(feet)
        self._amends = self._amends.since(stepper.landed)
        self._obey(state.time)
        stepper.fix_imminent(state.time)
        support, local, window = self._sight(state)
        if self._steps_out(local, window):
            support, local, window = self._sight(state)
        # Online constraints generator: the box comes with the reference, the reach of the feet here.
        situation = Situation.of(state.time, stepper, local, feet, support, window)
        margins = self._margins(situation, local, support, window)
        # Steps that a law moves of its own accord may save more than the margin says.
        if self._reserve is not None or not stepper.adapts:
            self._alarm.update(margins[1])
        catch = self._catch(situation)
        if catch is not None and catch.more and self._adds_steps(margins[0]):
            support, local, window = self._sight(state)
            catch = self._catch(Situation.of(state.time, stepper, local, feet, support, window))
        left = stepper.time_left
        if catch is not None and stepper.end_in(catch.left, state.time):
            window = self._window(state, support, local)
            self._amends.delay += stepper.time_left - left
        problem = self._problem(local, feet, support, window, catch)
        # TVMPC, or the law that stands in its place.
        motion = self.motion = self._law.plan(problem)
        shifts = motion.shifts @ support.rotation.T
        footsteps = stepper.upcoming(state.time, shifts)
        if stepper.free[0]:
            self._amends.shift = shifts[0]
        if stepper.swing_foot is not None:
            held = motion.solver is SolverStatus.HELD
            stepper.swing_to(footsteps[0].footstep, state.time, feet, held)
        balance = Balance(*margins, self._amends.shift, self._amends.delay)
        self._plan = self._world_plan(state.time, support, window, local, motion, footsteps, balance)
        return self._plan

    def _sight(self, state: CentroidalState) -> tuple[Support, Array, Window]:
        """What carries the robot now, its CoM in that plan frame, and the references from now on."""
        support = self._outlook.support(self._stepper)
        local = self._local_state(state, support)
        return support, local, self._window(state, support, local)

    def _window(self, state: CentroidalState, support: Support, local: Array) -> Window:
        """References from now on, as the clock goes."""
        stepper, outlook = self._stepper, self._outlook
        # ZMP planner: the ZMP that the footsteps define, from what carries the robot now.
        samples = stepper.samples(outlook.reach)
        reference = outlook.zmp(samples, support)
        # Vertical motion planner of the CoM, with it the varying dynamics.
        height = outlook.com_height(stepper, samples, support, reference)
        return outlook.window(stepper, samples, support, reference, height, local[:, 0], state.time, state.lasting)

    def _steps_out(self, local: Array, window: Window) -> bool:
        """Order a step of a robot that stands and would fall, or stands astride; says whether."""
        stepper = self._stepper
        if self._recovery is None or not stepper.stands:
            return False
        length = self.parameters.size.length
        error, falls = self._recovery.topples(local[:, 0] + local[:, 1] / window.omega[0], window)
        if not falls:
            # Once it is at rest the robot brings its feet side by side again.
            # Feet without a CoP of their own would end in a wide step, since there is no time to shift the weight.
            calm = self.parameters.cop_authority[1] > 0.0 and np.abs(error).max() < CALM * length
            calm = calm and stepper.astride > ASTRIDE * length
            if calm:
                stepper.go_on(at_once=False)
            return bool(calm)
        # The foot that carries stays, and the other one is brought to it.
        stance = None
        if stepper.phase.kind is PhaseKind.STAND and abs(error[1]) > ASIDE * length:
            stance = Foot.LEFT if error[1] > 0.0 else Foot.RIGHT
        stepper.go_on(None if stance is None else stance.other)
        return True

    def _adds_steps(self, margin: float) -> bool:
        """Add steps before those to come where the next one leaves something to catch; says whether.

        A robot that would stand makes one on the spot. On faces that footsteps were chosen for, one step of each foot
        where it stands is sooner made than one that climbs.

        Args:
            margin: of the DCM inside what the CoP captures with steps as planned [m].
        """
        stepper = self._stepper
        if stepper.stops:
            stepper.go_on()
        elif margin < 0.0 and stepper.climbs_next:
            stepper.step_again()
        else:
            return False
        return True

    def _margins(
        self, situation: Situation | None, local: Array, support: Support, window: Window
    ) -> tuple[float, float]:
        """How far the DCM is inside what the CoP alone captures, and with steps moved [m]."""
        stepper, p, dcm = self._stepper, self.parameters, local[:, 0] + local[:, 1] / window.omega[0]
        planned = planned_margin(dcm, window, p.sample_time, p.foot_margin)
        if situation is None:
            return (max(planned, signed_distance(support.outer, support.origin + support.rotation @ dcm)),) * 2
        if self._reserve is None or not stepper.adapts:
            return planned, planned
        # Where any ground will do, steps are added when there are no more.
        steps = MOST_STEPS if stepper.wide else min(stepper.remaining, MOST_STEPS)
        moved = self._reserve.margins(situation, steps, fixed=not stepper.free[0])
        return planned, max(planned, float(moved[-1]))

    def _catch(self, situation: Situation | None) -> Catch | None:
        """What is made of the next step where the CoP alone does not hold the body."""
        stepper = self._stepper
        if self._recovery is None or situation is None or not stepper.free[0]:
            return None
        if stepper.swing_foot is not None and stepper.swing is None:
            return None
        catch = self._recovery.catch(situation)
        stepper.adapted |= catch is not None
        return catch

    def _world_plan(
        self,
        time: float,
        support: Support,
        window: Window,
        local: Array,
        motion: Motion,
        footsteps: tuple[PlannedFootstep, ...],
        balance: Balance,
    ) -> WalkPlan:
        """What a tick has decided, in the world frame."""
        stepper, reference, to_world = self._stepper, window.reference, support.rotation.T
        count = self.parameters.horizon + 1
        moving = trajectory(self._prediction, local, window.stiffness[:count], motion.jerk)
        com = np.empty((3, count, 3))
        com[:, :, :2] = moving.com @ to_world
        com[0, :, :2] += support.origin
        com[:, :, 2] = window.height.height[:, :count]
        point = reference.point[:count] + reference.gain[:count] @ motion.shifts
        return WalkPlan(
            time=time,
            sample_time=stepper.sample_time,
            com=com[0],
            com_velocity=com[1],
            com_acceleration=com[2],
            jerk=moving.jerk @ to_world,
            zmp=(moving.zmp + window.offset[:count]) @ to_world + support.origin,
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
            footsteps=footsteps,
            swing=stepper.swing,
            roll=stepper.roll(time),
            status=self._status(motion),
            balance=balance,
        )

    def _problem(
        self, local: Array, feet: FeetState, support: Support, window: Window, catch: Catch | None
    ) -> MotionProblem:
        jerk = np.zeros((self.parameters.horizon + 1, 2))
        if self._plan is not None:
            jerk[:-1] = self._plan.jerk @ support.rotation
        return MotionProblem(
            state=local,
            stiffness=window.stiffness,
            omega=window.omega,
            reference=window.driving,
            steps=self._step_context(support, feet, catch),
            last_jerk=jerk[0],
            fallback=jerk[1:],
            rotation=support.rotation,
        )

    def _step_context(self, support: Support, feet: FeetState, catch: Catch | None) -> StepContext:
        stepper, steps = self._stepper, self._stepper.footsteps
        row, swing = stepper.row, stepper.swing_foot
        increment = np.zeros((2, 2))
        ahead = np.diff(steps.position[row : row + 3, :2], axis=0) @ support.rotation
        increment[: len(ahead)] = ahead
        side = 1.0 if steps.feet[row] is Foot.RIGHT else -1.0
        here = None if swing is None else (feet.position[swing, :2] - support.origin) @ support.rotation
        left = 0.0 if swing is None else stepper.time_left
        context = StepContext(increment, (side, -side), stepper.free, here, left, stepper.transfer_time)
        if self._recovery is None:
            return context
        if not stepper.adapted:
            return replace(context, reach=(increment, increment))
        legs = [self._recovery.legs.turned(stepper.turn(ahead)) for ahead in (0, 1)]
        boxes = [legs[0].beside(increment[0], side), legs[1].beside(increment[1], -side)]
        low, high = np.array(boxes).swapaxes(0, 1)
        rooms = np.zeros((2, 2, 2))
        rooms[: len(ahead)] = [stepper.room(number) for number in range(len(ahead))]
        low, high = np.maximum(low, increment + rooms[:, 0]), np.minimum(high, increment + rooms[:, 1])
        if catch is not None:
            low[0], high[0] = catch.low, catch.high
        return replace(context, reach=(low, high))

    def _local_state(self, state: CentroidalState, support: Support) -> Array:
        """Position and velocity as measured, acceleration as the last plan had it for now."""
        local = np.empty((3, 2))
        local[0] = state.com[:2] - support.origin
        local[1] = state.com_velocity[:2]
        local[2] = self._plan.com_acceleration[1, :2] if self._plan is not None else 0.0
        return np.ascontiguousarray((local @ support.rotation).T)

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
            falling=self._alarm.given,
        )
