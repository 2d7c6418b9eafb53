"""Recovery: what is made of the steps to come where the CoP alone does not hold the body."""

import math
from collections.abc import Callable

import numpy as np

from surefoot.planner.geometry import frame_rotation, signed_distance
from surefoot.planner.parameters import RecoveryParameters
from surefoot.planner.plan import WalkPlan
from surefoot.planner.recovery.capture_margin import CaptureMargin
from surefoot.planner.recovery.outlook import Outlook
from surefoot.planner.recovery.step_adjustment import StepAdjustment
from surefoot.planner.recovery.step_problem import StepBounds, StepProblem
from surefoot.planner.references.window import Window
from surefoot.planner.references.zmp_reference import Support
from surefoot.planner.steps.adaptation import Dcm, with_step_in_place, with_steps_repeated
from surefoot.planner.steps.execution import Execution
from surefoot.planner.steps.foresight import ended, going_again
from surefoot.planner.steps.step import room_left
from surefoot.planner.swing.step_region import Shifts, reachable_shifts, shifts_within, unshifted
from surefoot.planner.types import Array, Balance, FeetState, Foot, PhaseKind

_UNTOLD = Balance()

Sight = tuple[Support, Array, Window]
"""What carries the robot, CoM position, velocity and acceleration in that plan frame, shape (2, 3), and references."""

See = Callable[..., Sight]
"""Tells what is seen: as the execution is, or as another one would be that is its argument."""


def counted(before: Balance, movable: float, numbers: RecoveryParameters, unsure: float = 0.0) -> tuple[int, int]:
    """`Balance.lost` and `Balance.safe` of a plan with a margin after another plan.

    Args:
        before: of that other one.
        movable: how far the DCM is inside what steps that are moved capture [m].
        numbers: of the planner.
        unsure: how far the DCM may be from where it is estimated [m].
    """
    lost = before.lost + 1 if movable < -numbers.fall_margin else 0
    return lost, before.safe + 1 if movable >= unsure else 0


def falling(balance: Balance, before: bool, numbers: RecoveryParameters) -> bool:
    """Whether a fall is coming: some plans on end tell it, and some that have margin again take it back.

    Args:
        balance: of this plan.
        before: whether it was coming in the plan before.
        numbers: of the planner.
    """
    return balance.safe < numbers.regained_plans if before else balance.lost >= numbers.fall_plans


def capture_point(local: Array, window: Window) -> tuple[Array, Array]:
    """CoM and DCM of a position and velocity per axis at the begin of a window, shape (2,) each [m]."""
    com = local[:, 0]
    return com, com + local[:, 1] / window.omega[0]


class Recovery:
    """Watches the balance of the body, inserts steps, and adjusts the next one, of an execution.

    Args:
        execution: the clock and the steps in sight.
        half_size: half of the sole's length and width, shape (2,) [m].

    Attributes:
        adjustment: of the next step; None where the legs are not known.
    """

    def __init__(self, execution: Execution, half_size: Array) -> None:
        self._execution, legs = execution, execution.legs
        self._parameters = p = execution.schedule.ground.parameters
        self._planned = Outlook(p)
        self._movable = None if legs is None else CaptureMargin(legs, p, half_size)
        self.adjustment = None if legs is None else StepAdjustment(legs, p)

    def planned(self, local: Array, window: Window) -> float:
        """How far the DCM is inside what the CoP captures with steps as planned [m]; arguments as of `balance`."""
        return self._planned.margin(capture_point(local, window)[1], window)

    def landing(self, feet: FeetState, dcm: Callable[[], Dcm | None], see: See, sight: Sight) -> Sight:
        """Let single support of a step that catches the body end with its touchdown, and tell what is seen then.

        It ends where the CoP captures more at once, from both feet, than after the wait for the planned time. A DCM
        that has gone too far goes farther while the foot waits. One that is short of the foot would need a next step
        to catch it, and that step another one.

        Args:
            feet: the measured feet.
            dcm: tells the DCM in the world frame.
            see: tells what is seen, be it of another execution.
            sight: of this one.
        """
        execution = self._execution
        if not execution.may_end(feet, dcm):
            return sight
        other = ended(execution, feet)
        if self.planned(*see(other)[1:]) <= self.planned(*sight[1:]):
            return sight
        execution.adopt(other)
        return see()

    def steps_out(self, local: Array, window: Window) -> bool:
        """Insert a step of a robot that stands and would fall, or stands astride; says whether."""
        execution = self._execution
        if not execution.stops or self.adjustment is None or not execution.adapts or execution.info.leads_to:
            return False
        schedule, now = execution.schedule, execution.clock.now
        numbers, standing = self._parameters.recovery, execution.phase.kind is PhaseKind.STAND
        error = (capture_point(local, window)[1] - self._planned.nominal(window)).tolist()
        box, most = window.driving.half_size[-1].tolist(), max(map(abs, error))
        if all(abs(astray) <= numbers.stand_share * half for astray, half in zip(error, box, strict=True)):
            # Once it is at rest the robot brings its feet side by side again.
            # Feet without a CoP of their own would end in a wide step, since there is no time to shift the weight.
            calm = self._parameters.cop_authority[1] > 0.0 and most < numbers.calm
            here, usual = schedule.apart(execution.landed)
            calm = calm and standing and float(np.hypot(*(here - usual))) > numbers.apart
            if calm:
                execution.follow(with_step_in_place(schedule, now, at_once=False))
            return bool(calm)
        # The foot that carries stays, and the other one is brought to it.
        foot = None
        if standing and abs(error[1]) > numbers.tolerance:
            foot = Foot.RIGHT if error[1] > 0.0 else Foot.LEFT
        execution.follow(with_step_in_place(schedule, now, foot))
        return True

    def adds_steps(self, margin: float) -> bool:
        """Insert steps before those to come where the next one leaves something to catch; says whether.

        A robot that would stand makes one on the spot. On faces that footsteps were chosen for, one step of each foot
        where it stands is sooner made than one that climbs.

        Args:
            margin: of the DCM inside what the CoP captures with steps as planned [m].
        """
        execution, schedule, now = self._execution, self._execution.schedule, self._execution.clock.now
        if schedule.stops(now):
            execution.follow(with_step_in_place(schedule, now))
            return True
        if margin < 0.0 and schedule.climbs_next(now):
            execution.follow(with_steps_repeated(schedule, execution.phase.step))
            return True
        return False

    def goes_again(
        self,
        time: float,
        feet: FeetState,
        see: See,
        sight: Sight,
        balance: Balance,
        unsure: float = 0.0,
    ) -> bool:
        """Let the foot that landed last make the next step as well, where that captures clearly more; says whether.

        The DCM is past its inner edge, and the other foot would have to cross it. The weight has to go back meanwhile,
        in which the DCM goes on: ahead, that may be more than the steps after it catch. Steps alternate on from there.

        Args:
            time: now [s].
            feet: the measured feet.
            see: as of `landing`.
            sight: likewise.
            balance: of the steps in the order in which they are.
            unsure: as of `balance`.
        """
        execution, numbers, (support, local, window) = self._execution, self._parameters.recovery, sight
        if balance.planned + unsure > -numbers.tolerance or self._movable is None or self.adjustment is None:
            return False
        if not execution.may_go_again:
            return False
        places, schedule = capture_point(local, window), execution.schedule
        foot = schedule.step(execution.landed).place.foot
        if not feet.contact[foot] or foot.side * float(places[1][1]) <= -float(schedule.ground.half_size[1]):
            return False
        other = going_again(execution)
        stance = other.schedule.step(other.landed).place
        # A foot that landed short, or whose landing was put off, is no longer where the schedule has it.
        if math.dist(feet.position[stance.foot], stance.position) > numbers.tolerance:
            return False
        rotation, origin = frame = frame_rotation(stance.yaw), stance.position[:2]
        again = StepProblem.of(time, other, feet, frame)
        if again is None:
            return False
        com, dcm = ((support.origin + support.rotation @ place - origin) @ rotation for place in places)
        margins = self._movable.margins(com, dcm, float(window.omega[0]), again, self._counted(other))
        if margins[-1] < balance.movable + unsure + numbers.tolerance:
            return False
        _, local, window = see(other)
        found = self.adjustment.solve(*capture_point(local, window), window, again, unsure)
        if found is not None and found.cost > numbers.again_cost:
            return False
        execution.adopt(other)
        return True

    def _counted(self, execution: Execution) -> int:
        """Steps that the margin counts with."""
        ahead = len(execution.schedule.after(execution.landed))
        return execution.schedule.ground.terrain.footholds.counted(ahead, self._parameters.recovery.most_steps)

    def balance(
        self,
        step: StepProblem | None,
        local: Array,
        support: Support,
        window: Window,
        last: WalkPlan | None,
        unsure: float = 0.0,
    ) -> Balance:
        """How far the DCM is inside what is captured, and what the last plan has made of the landing to come.

        Args:
            step: that lands next; None where none is to come.
            local: CoM position, velocity and acceleration per axis of the plan frame, shape (2, 3).
            support: what carries the robot now, with the plan frame.
            window: references.
            last: the plan before; None for the first.
            unsure: how far the DCM may be from where it is estimated, by which both margins are less [m].
        """
        execution, p, (com, dcm) = self._execution, self._parameters, capture_point(local, window)
        planned = movable = self._planned.margin(dcm, window)
        if step is None:
            planned = movable = max(planned, signed_distance(support.outer, support.origin + support.rotation @ dcm))
        elif self._movable is not None and execution.adapts:
            steps, omega, fixed = self._counted(execution), float(window.omega[0]), not execution.free[0]
            movable = max(planned, float(self._movable.margins(com, dcm, omega, step, steps, fixed)[-1]))
        kept = last is not None and last.phase.landed == execution.landed
        shift, delay = (last.balance.shift, last.balance.delay) if last is not None and kept else (np.zeros(2), 0.0)
        # Hips save many that are less far out. Steps that a law moves of its own accord may save more than that.
        told = self._movable is not None or not execution.adapts
        lost = safe = 0
        if movable < unsure or (last is not None and last.status.falling):
            lost, safe = counted(_UNTOLD if last is None else last.balance, movable, p.recovery, unsure)
        return Balance(planned - unsure, movable - unsure, shift, delay, lost if told else 0, False, safe)

    def adjusted(
        self, step: StepProblem | None, local: Array, window: Window, unsure: float = 0.0
    ) -> StepBounds | None:
        """What is made of the next step where the CoP alone does not hold the body, as far as that is sure [m]."""
        execution = self._execution
        if self.adjustment is None or step is None or not execution.free[0]:
            return None
        adjusted = self.adjustment.solve(*capture_point(local, window), window, step, unsure)
        execution.adapted |= adjusted is not None
        return adjusted

    def bounds(
        self,
        increment: Array,
        free: tuple[bool, bool],
        here: Array | None,
        left: float,
        adjusted: StepBounds | None,
    ) -> Shifts:
        """Where the next two footsteps may land.

        Args:
            increment: their nominal displacements from the foothold before, in the plan frame, shape (2, 2) [m].
            free: whether each of them may be shifted.
            here: position of the swing foot from the stance foot, shape (2,) [m], or None when no foot swings.
            left: time until the first of them lands [s].
            adjusted: what is made of the next one.
        """
        execution, schedule, landed = self._execution, self._execution.schedule, self._execution.landed
        if execution.legs is not None and adjusted is None and not execution.adapted:
            return unshifted(free)
        stance, legs = schedule.step(landed).place, execution.legs
        if legs is None:
            return reachable_shifts(self._parameters, increment, stance.foot.other.side, free, here, left)
        boxes = np.stack((increment, increment), axis=1)
        for n, step in enumerate(schedule.after(landed)[:2] if execution.adapted else ()):
            room = increment[n] + room_left(step, stance, self._parameters.recovery.parallel)
            low, high = legs.turned(schedule.turn(step.number)).beside(increment[n], step.place.foot.side)
            boxes[n] = np.maximum(low, room[0]), np.minimum(high, room[1])
        if adjusted is not None:
            boxes[0] = adjusted.box
        return shifts_within(boxes, increment, free)
