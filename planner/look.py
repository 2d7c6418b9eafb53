"""A look at a walk: what carries the robot, what is known of horizon and preview, and how much balance is left."""

import math
from dataclasses import dataclass, replace

import numpy as np

from surefoot.forces import ExternalLoad
from surefoot.planner.geometry.plane import signed_distance
from surefoot.planner.measured import Measured
from surefoot.planner.model.dcm import dcm, natural_frequency
from surefoot.planner.recovery.falling import counted
from surefoot.planner.recovery.step_problem import StepBounds, StepProblem, landing_place
from surefoot.planner.references.com_height import HeightPreview, law_height, preview_height
from surefoot.planner.references.height_transition import HeightTransition
from surefoot.planner.references.offset_table import OffsetTable
from surefoot.planner.references.window import Window, lean
from surefoot.planner.references.zmp_reference import (
    Support,
    SupportKey,
    load_left,
    on_edges,
    present_support,
    zmp_reference,
)
from surefoot.planner.state import HeightMemory, Memory, WalkState
from surefoot.planner.steps.phases import PhaseSamples
from surefoot.planner.types import Array, Balance, PhaseKind

_STILL, _UNKNOWN = np.zeros(3), Balance()


@dataclass(frozen=True, eq=False)
class View:
    """A state of a walk, and what is seen of it.

    Attributes:
        state: which remembers this look.
        measured: of this tick.
        support: what carries the robot, with the plan frame.
        local: CoM position, velocity and acceleration per axis of the plan frame, shape (2, 3) [m, m/s, m/s^2].
        dcm: in the plan frame, shape (2,) [m].
        window: references from now on.
        uncertainty: how far the DCM may be from where it is estimated [m].
        step: that lands next; None where none is to come.
        balance: how far the DCM is inside what is captured.
        bounds: of the next step, where it is adjusted in this tick.
    """

    state: WalkState
    measured: Measured
    support: Support
    local: Array
    dcm: Array
    window: Window
    uncertainty: float
    step: StepProblem | None
    balance: Balance
    bounds: StepBounds | None = None

    @property
    def com(self) -> Array:
        """CoM in the plan frame, shape (2,) [m]."""
        return self.local[:, 0]

    @property
    def planned(self) -> float:
        """Margin of the DCM in what the CoP captures with the steps as planned [m]."""
        return self.state.model.outlook.margin(self.dcm, self.window)

    @property
    def off(self) -> Array:
        """Offset of the DCM from where the steps as planned would have it, shape (2,) [m]."""
        return self.dcm - self.state.model.outlook.nominal(self.window)

    def of(self, state: WalkState) -> "View":
        """The same tick in another state."""
        return look(state, self.measured)

    def retimed(self, state: WalkState) -> "View":
        """The same tick in a state whose phases end at other times; the robot stands as before."""
        body = self.measured.body
        window, memory = references(state, self.support, self.com, body.time, body.lasting)
        return replace(self, state=replace(state, memory=memory), window=window)


def look(state: WalkState, measured: Measured) -> View:
    """Look at a state in a tick.

    Args:
        state: now.
        measured: of the tick.
    """
    model = state.model
    margin, room = model.parameters.foot_margin, model.parameters.cop_room
    edges = state.phase.edges(state.clock.now) if state.phase.rolls else (0, 0)
    key = SupportKey(state.schedule, state.landed, state.phase.start, state.free, edges)
    last = state.memory.support
    kept = last is not None and last.key == key
    support = last if last is not None and kept else present_support(key, state.phase.kind, margin, room)
    # Position and velocity as measured, acceleration as the last plan had it for now.
    bend = _STILL if state.plan is None else state.plan.com_acceleration[1]
    local = model.world.local(measured.body.com, measured.body.com_velocity, bend, support.frame)
    window, memory = references(state, support, local[:, 0], measured.time, measured.body.lasting)
    state, omega = replace(state, memory=memory), float(window.omega[0])
    here, uncertainty = dcm(local[:, 0], local[:, 1], omega), measured.dcm_uncertainty(omega)
    step = next_step(state, measured, support)
    balance = weighed(state, (local[:, 0], here), support, window, step, uncertainty)
    return View(state, measured, support, local, here, window, uncertainty, step, balance)


def references(
    state: WalkState, support: Support, position: Array, time: float, lasting: ExternalLoad | None
) -> tuple[Window, Memory]:
    """The references from now on, and what the next look remembers of them.

    Args:
        state: now.
        support: what carries the robot, with the plan frame.
        position: CoM in the plan frame, shape (2,) [m].
        time: now [s].
        lasting: force that goes on acting on the body.
    """
    model = state.model
    samples, count = state.samples(model.reach), model.count
    # The paper's ZMP planner, and its vertical motion planner with the varying dynamics.
    flat = zmp_reference(samples, support.table)
    whole = on_edges(flat, samples, support, model.parameters.horizon + 1).part(slice(1, model.reach + 1))

    law = law_height(model.heights, model.gait, samples, support.heights)
    course, transition, seen_height = _transferred(state, law)
    high = preview_height(model.heights, course, whole.height, model.parameters.size.length)
    offset, table = _offsets(state, support, (samples, whole.point, high), position, time, lasting)
    memory = Memory(support, table, transition, seen_height)
    reference, height, window = whole.part(slice(count)), high.part(count), slice(1, count + 1)
    stiffness = model.softening * height.stiffness
    if lasting is not None:
        offset = offset + lean(lasting, support.rotation, height)
    seen = Window(
        reference=reference,
        driving=reference.less(offset),
        offset=offset,
        height=height,
        stiffness=stiffness,
        omega=natural_frequency(stiffness, state.clock.sample_time),
        load_left=load_left(samples, support.on_left)[window],
        contacts=samples.contacts[window],
    )
    return seen, memory


def _transferred(state: WalkState, law: Array) -> tuple[Array, HeightTransition | None, HeightMemory]:
    """The height where a step that is adapted has changed how the clock goes or set it, or is too long for it.

    Else it is that of the law.

    Args:
        state: now.
        law: z, z', z'' by it, shape (3, n) [m, m/s, m/s^2].
    """
    clock = state.clock
    lower = state.lowering
    leaves = False
    numbers = state.model.parameters.recovery
    before, transition, height = state.memory.height, state.memory.transition, law
    if before is not None:
        pushed = state.adapted or transition is not None or not clock.coefficients
        leaves = before.course != clock.course and pushed
        leaves |= abs(lower - before.lower) > numbers.same_height or (before.lower > 0.0) is not (lower > 0.0)
        lower = lower if leaves else before.lower
    if lower:
        height = law - np.array([[lower], [0.0], [0.0]])
    if leaves and before is not None:
        now, t = before.height[:, min(clock.ticks - before.tick, 1)], clock.sample_time
        transition = HeightTransition.onto(height, now, clock.ticks, state.left, t, numbers.lifting)
    if transition is not None and clock.ticks >= transition.start + transition.samples:
        transition = None
    if transition is not None:
        height = transition.over(height, clock.ticks)
    seen = HeightMemory(clock.ticks, clock.course, height[:, :2].copy(), lower)
    return height, transition, seen


def _offsets(
    state: WalkState,
    support: Support,
    beyond: tuple[PhaseSamples, Array, HeightPreview],
    position: Array,
    time: float,
    lasting: ExternalLoad | None,
) -> tuple[Array, OffsetTable | None]:
    """ZMP that the legs add, shape (n, 2) [m], and the table that it comes from.

    Args:
        state: now.
        support: what carries the robot.
        beyond: the walk at all samples that are looked at: phases, with a sample before and one after, ZMP [m], and
            CoM height.
        position: CoM in the plan frame, shape (2,) [m].
        time: now [s].
        lasting: force that goes on acting on the body.
    """
    model = state.model
    count = state.model.count
    clock = state.clock
    numbers = state.model.parameters.recovery
    if model.leg_offset is None:
        return np.zeros((count, 2)), None
    last = state.schedule.last_phase
    table = state.memory.offsets
    key = support.key
    aim = state.aim
    # In the final standing, where the walk's clock does not matter, none serves: its values go on with time.
    left = last.start - clock.now if math.isinf(last.samples) else math.inf
    # A swing that a command retimes is laid anew at every tick, by what the clock shows then.
    serves = left > 0.0 and (clock.steady or state.adapted)
    if table is None or not serves or not table.holds(clock, key, aim, numbers.same_swing):
        # No longer than until the robot stands will they serve.
        count += int(min(numbers.offset_ticks - 1, max(left, 0.0) + 1))
        samples, point, height = beyond
        point = point if lasting is None else point - lean(lasting, support.rotation, height)
        swing = state.swing.trajectory
        moving = samples, state.aimed, support.frame, None if swing is None or aim is None else (swing, time)
        # While a step is adapted it is made from the last one.
        guess = None
        if table is not None and (aim is not None or not clock.steady):
            guess = table.guess(clock.ticks, key, count)
        values = model.leg_offset.made(moving, point[:count], height.part(count), position, guess)
        table = OffsetTable(clock.ticks, key, clock.course, aim, values, numbers.offset_ticks)
    return table.since(clock.ticks, model.count), table


def next_step(state: WalkState, measured: Measured, support: Support) -> StepProblem | None:
    """The step that lands next, seen from its stance foot; None where none is to come."""
    phase = state.info
    if not phase.leads_to:
        return None
    model, schedule, clock = state.model, state.schedule, state.clock
    step, stance = schedule.step(state.landed + 1), schedule.step(state.landed)
    foot, swing, (rotation, origin) = step.place.foot, state.swing.trajectory, support.frame
    velocity = np.zeros(2) if swing is None else swing.coefficients(measured.time)[1, :2]
    swings = phase.kind is PhaseKind.SINGLE
    place, face, shortest, crosses = landing_place(step, stance, schedule.ground, model.hardest)
    return StepProblem(
        place=place,
        swing=np.array((_turned(measured.feet.position[foot, :2] - origin, rotation), _turned(velocity, rotation))),
        double=0.0 if swings else phase.left,
        single=phase.left if swings else step.single_support * clock.sample_time,
        cycle=schedule.gait.period,
        shortest=min(1.0, (step.touchdown - clock.now) / step.single_support) * shortest,
        face=face,
        crosses=crosses,
        last=state.stops,
        adapted=state.adapted,
    )


def _turned(way: Array, rotation: Array) -> tuple[float, float]:
    """A way in the world, shape (2,), in the plan frame; a product of small arrays would round otherwise."""
    (x, y), ((a, b), (c, d)) = way.tolist(), rotation.tolist()
    return x * a + y * c, x * b + y * d


def counted_steps(state: WalkState) -> int:
    """Steps that the margin counts with."""
    model, ahead = state.model, len(state.schedule.after(state.landed))
    return model.terrain.footholds.counted(ahead, model.parameters.recovery.most_steps)


def weighed(
    state: WalkState,
    body: tuple[Array, Array],
    support: Support,
    window: Window,
    step: StepProblem | None,
    uncertainty: float,
) -> Balance:
    """Margin of the DCM in what is captured, and what the last plan has made of the landing to come.

    Args:
        state: now.
        body: CoM and DCM in the plan frame, shape (2,) each [m].
        support: what carries the robot now, with the plan frame.
        window: references.
        step: that lands next; None where none is to come.
        uncertainty: how far the DCM may be from where it is estimated, by which both margins are less [m].
    """
    model, last, (com, dcm) = state.model, state.plan, body
    planned = movable = model.outlook.margin(dcm, window)
    if step is None:
        planned = movable = max(planned, signed_distance(support.outer, support.origin + support.rotation @ dcm))
    elif model.margin is not None and model.adapts:
        steps, omega, fixed = counted_steps(state), float(window.omega[0]), not state.free[0]
        movable = max(planned, model.margin.margins(com, dcm, omega, step, steps, fixed).item(-1))
    kept = last is not None and last.phase.landed == state.landed
    shift, delay = (last.balance.shift, last.balance.delay) if last is not None and kept else (np.zeros(2), 0.0)
    # Hips save many that are less far out. Steps that a law moves of its own accord may save more than that.
    tells = model.margin is not None or not model.adapts
    lost = safe = 0
    if movable < uncertainty or (last is not None and last.status.falling):
        before = _UNKNOWN if last is None else last.balance
        lost, safe = counted(before, movable, model.parameters.recovery, uncertainty)
    return Balance(planned - uncertainty, movable - uncertainty, shift, delay, lost if tells else 0, False, safe)
