"""The capture margin of the DCM, held against linear programs that look for CoPs and footsteps."""

import itertools
from dataclasses import replace

import numpy as np
import pytest
from pendulum_walk import LEGS, walk_pendulum
from pushed_step import PushedStep
from scipy.optimize import linprog

from surefoot.forces import Push
from surefoot.planner.parameters import PlannerParameters, StepAdaptation
from surefoot.planner.planner import WalkingPlanner
from surefoot.planner.recovery.capture_margin import CaptureMargin
from surefoot.planner.recovery.falling import falling
from surefoot.planner.recovery.outlook import Outlook
from surefoot.planner.recovery.reach import StepReach
from surefoot.planner.references.com_height import HeightPreview
from surefoot.planner.references.window import Window
from surefoot.planner.references.zmp_reference import ZmpReference
from surefoot.planner.steps.gait import GaitParameters
from surefoot.planner.swing.leg_reach import ANYWHERE
from surefoot.planner.types import Balance, CentroidalState, Foot, Footstep, PhaseKind

pytestmark = pytest.mark.unit

P = PlannerParameters()
T, OMEGA, HALF = P.sample_time, 3.2, np.array([0.11, 0.055])
COUNT, SEGMENTS = P.horizon + P.preview + 1, 3


def window(half=0.9 * HALF):
    times = T * np.arange(COUNT)
    point = np.clip((times - 0.3) / 0.12, 0.0, 1.0)[:, None] * (0.36, 0.2)
    reference = ZmpReference(
        point, np.zeros((COUNT, 2)), np.broadcast_to(half, (COUNT, 2)), np.zeros(COUNT), np.zeros((COUNT, 2))
    )
    height = HeightPreview(np.ones((3, COUNT)), np.full(COUNT, OMEGA**2))
    still = np.zeros((COUNT, 2))
    stiffness, omega = np.full(COUNT, OMEGA**2), np.full(COUNT, OMEGA)
    return Window(reference, reference, still, height, stiffness, omega, still[:, 0], still > 0.0)


def landing(foot, ahead, left):
    return Footstep(foot, np.array([ahead, left, 0.0]), 0.0)


def situation(dcm=(0.1, 0.03), **keys):
    """A left step on the right foot, or before it."""
    given = {
        "com": np.array([0.02, 0.06]), "dcm": np.array(dcm), "place": landing(Foot.LEFT, 0.36, 0.2),
        "swing": np.array([[0.05, 0.2], [1.0, 0.0]]), "double": 0.0, "single": 0.3, "cycle": 0.62, "shortest": 0.0,
        "face": ANYWHERE, "adapted": False, "last": False, "crosses": True,
    }  # fmt: skip
    return PushedStep(**{**given, **keys})


SWINGING = situation()
SHIFTING = situation((0.0, 0.06), double=0.1, single=0.5, swing=np.array([[-0.3, 0.21], [0.0, 0.0]]))
RIGHT = situation((0.1, -0.03), com=np.array([0.02, -0.06]), place=landing(Foot.RIGHT, 0.36, -0.2),
                  swing=np.array([[0.05, -0.2], [1.0, 0.0]]))  # fmt: skip


class Law:
    """A margin of pushed steps."""

    def __init__(self, margin):
        self.margin, self.cycle = margin, margin.cycle

    def margins(self, now, steps, fixed=False):
        return self.margin.margins(now.com, now.dcm, OMEGA, now, steps, fixed)


def margin_of(legs=LEGS, timing=False):
    parameters = replace(P, step_adaptation=StepAdaptation.TIMING if timing else StepAdaptation.LOCATION)
    return Law(CaptureMargin(legs, parameters, HALF))


class Program:
    """CoPs, held for a third of each phase, and footsteps of one axis that bring the DCM to rest; linear in all."""

    def __init__(self, com, dcm, count):
        self.rows, self.bounds = [], []
        self.com, self.dcm = np.append(np.zeros(count), com), np.append(np.zeros(count), dcm)

    def variable(self):
        self.bounds.append((None, None))
        return np.eye(1, len(self.com), len(self.bounds) - 1)[0]

    def below(self, left, right):
        self.rows.append(left - right)

    def within(self, value, low, high):
        self.below(value, high)
        self.below(low, value)

    def hold(self, time, low, high):
        grown = np.exp(OMEGA * time / SEGMENTS)
        for _ in range(SEGMENTS):
            cop = self.variable()
            self.within(cop, low, high)
            away = self.dcm - cop
            self.com = self.com / grown + cop * (1.0 - 1.0 / grown) + 0.5 * away * (grown - 1.0 / grown)
            self.dcm = cop + grown * away

    def solved(self):
        rows = np.array(self.rows)
        found = linprog(
            np.zeros(len(self.bounds)), A_ub=rows[:, : len(self.bounds)], b_ub=-rows[:, -1], bounds=self.bounds
        )
        return found.success


def rests(now, axis, box, steps, together, legs=LEGS):
    """Return true if an axis can be brought to rest after exactly so many landings, of one perhaps on the stance
    foot."""
    half, side, cycle = HALF[axis], now.place.foot.side, now.cycle
    program = Program(now.com[axis], now.dcm[axis], (steps + 1) * (SEGMENTS + 1))
    one = np.eye(1, len(program.com), len(program.com) - 1)[0]
    if now.double:
        behind = now.swing[0, axis]
        program.hold(now.double, (min(behind, 0.0) - half) * one, (max(behind, 0.0) + half) * one)
    program.hold(now.single, -half * one, half * one)
    place = program.variable()
    program.within(place, box[0][axis] * one, box[1][axis] * one)
    reach = StepReach(legs)
    reach.see(now)
    program.within(place, -reach.swung(axis, -1.0, now.single) * one, reach.swung(axis, 1.0, now.single) * one)
    hip = program.com + axis * 0.5 * side * legs.hip_width * one
    program.within(place, hip - legs.radius * one, hip + legs.radius * one)
    for _ in range(steps - 1):
        side = -side
        program.hold(cycle, place - half * one, place + half * one)
        step = program.variable()
        both = legs.allowed(side, ANYWHERE, True)[0]
        program.within(step, both[0][axis] * one, both[1][axis] * one)
        place = place + step
    last = 0.0 * one if together else place
    program.within(program.dcm, last - half * one, last + half * one)
    return program.solved()


def captured(now, most, legs=LEGS):
    """Return true if the body can be brought to rest within so many landings."""
    return any(
        all(
            rests(now, axis, box, steps, False, legs) or (steps == 1 and rests(now, axis, box, 1, True, legs))
            for axis in (0, 1)
        )
        for steps, box in itertools.product(range(1, most + 1), legs.allowed(now.place.foot.side, ANYWHERE, True))
    )


def edge(now, direction, steps, law):
    """The state at the edge of what the law says is captured, in a direction from a state within [m]."""
    within, beyond = 0.0, 1.5
    for _ in range(30):
        middle = 0.5 * (within + beyond)
        moved = replace(now, dcm=now.dcm + middle * direction)
        within, beyond = (middle, beyond) if law.margins(moved, steps)[-1] > 0.0 else (within, middle)
    return within


@pytest.mark.parametrize("now", [SWINGING, SHIFTING, RIGHT], ids=["swinging", "shifting", "right"])
@pytest.mark.parametrize("steps", [1, 3])
@pytest.mark.parametrize("angle", np.linspace(-np.pi, np.pi, 5, endpoint=False))
def test_inside_the_margin_is_captured_and_outside_is_not(now, steps, angle):
    law, direction = margin_of(), np.array([np.cos(angle), np.sin(angle)])
    assert law.margins(now, steps)[-1] > 0.0
    way = edge(now, direction, steps, law)
    assert 0.02 < way < 1.4
    assert captured(replace(now, dcm=now.dcm + (way - 1e-3) * direction), steps)
    assert not captured(replace(now, dcm=now.dcm + (way + 1e-3) * direction), steps)


@pytest.mark.parametrize("angle", np.linspace(-np.pi, np.pi, 5, endpoint=False))
def test_a_step_that_is_decided_captures_what_lands_where_it_does(angle):
    law, direction, place = margin_of(), np.array([np.cos(angle), np.sin(angle)]), SWINGING.nominal
    now = replace(SWINGING, dcm=np.array([0.2, 0.1]))
    within, beyond = 0.0, 1.5
    for _ in range(30):
        middle = 0.5 * (within + beyond)
        inside = law.margins(replace(now, dcm=now.dcm + middle * direction), 1, fixed=True)[0] > 0.0
        within, beyond = (middle, beyond) if inside else (within, middle)
    grown = np.exp(OMEGA * now.single)
    edge = now.dcm + within * direction
    low, high = (np.minimum(place, 0.0) - HALF, np.maximum(place, 0.0) + HALF)
    landed = np.array([grown * edge + (1.0 - grown) * sign * HALF for sign in (1.0, -1.0)])
    # With its best CoP it lands at the edge of both feet on one axis, and can land within them on the other.
    assert (landed[0] < high + 1e-6).all()
    assert (landed[1] > low - 1e-6).all()
    assert min(np.abs(landed[0] - high).min(), np.abs(landed[1] - low).min()) < 1e-6


def states(count=40):
    moves = np.random.default_rng(0).uniform(-0.6, 0.6, (count, 2))
    return [replace(now, dcm=now.dcm + move) for now in (SWINGING, SHIFTING, RIGHT) for move in moves]


def test_more_steps_longer_legs_crossing_and_other_times_take_nothing_away():
    law, timed = margin_of(), margin_of(timing=True)
    short = margin_of(replace(LEGS, radius=0.3))
    beside = margin_of(replace(LEGS, across=None))
    gained = np.zeros(4)
    for now in states():
        margins = law.margins(now, 5)
        assert (np.diff(margins) >= 0.0).all()
        others = np.array([short.margins(now, 5)[-1], beside.margins(now, 5)[-1], margins[-1]])
        more = np.array([margins[-1], margins[-1], timed.margins(now, 5)[-1]])
        assert (others <= more + 1e-12).all()
        gained = np.maximum(gained, [np.ptp(margins), *(more - others)])
    assert (gained > 0.03).all()


def test_its_few_times_find_what_many_do():
    law, fixed = margin_of(timing=True), margin_of()
    for now in states():
        now = replace(now, place=landing(now.place.foot, *now.swing[0]), double=0.0)
        times = np.append(np.linspace(min(now.single, P.recovery.least_single), now.single + 0.2, 40), now.single)
        cycle = min(law.cycle, now.cycle)
        every = max(fixed.margins(replace(now, single=t, cycle=cycle), 3)[-1] for t in times)
        assert every - 0.03 < law.margins(now, 3)[-1] < every + 5e-3


@pytest.mark.parametrize("axis", [0, 1])
@pytest.mark.parametrize("sign", [-1.0, 1.0])
@pytest.mark.parametrize("aside", [0.0, 0.03])
def test_as_planned_the_cop_at_the_edge_of_its_boxes_holds_just_what_is_inside(axis, sign, aside):
    """The other axis has room; backward in time from rest with the CoP at the edge all the time.

    Boxes of feet that roll are not around the reference.
    """
    half = np.where(np.arange(2) == axis, 0.9 * HALF, 10.0)
    seen, step = window(half), 1e-3
    middle = aside * np.sin(0.2 * np.arange(COUNT))[:, None] * (1.0, -0.5)
    seen = replace(seen, driving=replace(seen.driving, middle=middle))
    times = np.arange(0.0, T * (COUNT - 1), step)
    edges = seen.driving.point[:, axis] + middle[:, axis]
    cop = np.interp(times, T * np.arange(COUNT), edges) + sign * HALF[axis]
    edge = cop[-1]
    for point in cop[::-1]:
        edge = point + (edge - point) * np.exp(-OMEGA * step)
    for margin in (-0.01, 0.0, 0.01):
        dcm = np.where(np.arange(2) == axis, edge - sign * margin, 0.0)
        assert abs(Outlook(replace(P, foot_margin=0.9)).margin(dcm, seen) - margin) < 1e-3


GAIT = GaitParameters(steps=5, step_length=0.3, single_support=0.5, double_support=0.12, com_height=0.95)


def plans(stand, impulse=0.0, aside=0.0, **keys):
    parameters, begin = replace(P, **keys), GAIT.lift_off(3) + 0.25
    planner = WalkingPlanner(GAIT, stand(), 0.22, 0.11, parameters=parameters, legs=LEGS)
    push = Push(begin, 0.1, 1000.0 * np.array([impulse, aside, 0.0]))
    com = np.array([0.0, 0.0, GAIT.com_height])
    trace = walk_pendulum(planner, stand(), GAIT.duration + 0.5, com=com, pushes=(push,) if impulse or aside else ())
    return begin, trace.plans, trace.fall_time


@pytest.mark.parametrize("adaptation", [StepAdaptation.NONE, StepAdaptation.CROSSING])
def test_an_undisturbed_walk_keeps_its_margins_and_moves_no_step(stand, adaptation):
    _, made, _ = plans(stand, step_adaptation=adaptation)
    for plan in made:
        balance = plan.balance
        assert 0.03 < balance.planned <= balance.movable
        movable = adaptation is not StepAdaptation.NONE and plan.phase.leads_to > 0
        assert movable or balance.movable == balance.planned
        assert not movable or plan.phase.leads_to == GAIT.steps or balance.movable > balance.planned
        assert np.abs(balance.shift).max() < 1e-3
        assert balance.delay == 0.0
        assert not balance.catching


def test_who_stands_still_is_captured_by_the_support(stand):
    _, made, _ = plans(stand)
    assert made[-1].phase.leads_to == 0
    assert made[-1].balance.planned == made[-1].balance.movable == pytest.approx(0.11, abs=2e-3)  # half a sole's length


def test_a_push_is_told_by_the_margins_and_what_is_made_of_the_step(stand):
    begin, made, fallen = plans(stand, 0.4)
    assert fallen is None
    after = [plan for plan in made if begin + 0.1 < plan.time and plan.phase.step == 3]
    assert min(plan.balance.planned for plan in after) < 0.0 < min(plan.balance.movable for plan in after)
    assert not any(plan.balance.catching for plan in made if plan.time <= begin)
    landing = max(plan.balance.shift[0] for plan in after)
    assert landing > 0.05
    swung = [plan for plan in after if plan.swing is not None][-1]
    assert swung.balance.catching  # where the footstep is fixed already, too
    nominal = GAIT.lift_off(3) + GAIT.single_support
    assert swung.footsteps[0].position[0] - 0.9 == pytest.approx(swung.balance.shift[0], abs=5e-3)
    assert swung.footsteps[0].touchdown_time - nominal == pytest.approx(swung.balance.delay, abs=1.5 * T)


def test_a_swing_is_hurried_from_its_first_plan_on(stand):
    _, made, fallen = plans(stand, 1.2)
    assert fallen is None
    first = next(plan for plan in made if plan.phase.kind is PhaseKind.SINGLE and plan.phase.step == 4)
    assert first.phase.elapsed < T
    assert first.phase.left < GAIT.single_support - 0.05


def test_a_step_that_catches_the_body_moves_until_shortly_before_it_lands(stand):
    def late_shift(**keys):
        _, made, _ = plans(stand, 1.2, **keys)
        pairs = [(a, b) for a, b in itertools.pairwise(made) if a.swing is not None and b.swing is not None]
        left = [(a, b) for a, b in pairs if 0.03 < b.swing.touchdown_time - b.time < 0.07 and b.balance.catching]
        same = [(a, b) for a, b in left if a.footsteps[0].step == b.footsteps[0].step]
        assert same
        return max(float(np.abs(b.footsteps[0].position - a.footsteps[0].position).max()) for a, b in same)

    assert late_shift(freeze_catching=0.08) < 1e-6 < 1e-4 < late_shift()


def test_who_falls_was_outside_before(stand):
    """Pushed to its right, over the foot that stands."""
    _, made, fallen = plans(stand, aside=-1.6)
    assert fallen is not None
    assert min(plan.balance.movable for plan in made if plan.time < fallen - 0.1) < -0.03


def test_a_fall_is_told_by_plans_on_end_far_outside(stand):
    numbers = P.recovery
    _, made, fallen = plans(stand, aside=-1.6)
    lost = 0
    for plan in made:
        lost = lost + 1 if plan.balance.movable < -numbers.fall_margin else 0
        assert plan.balance.lost == lost
    first = next(plan for plan in made if plan.status.falling)
    assert first.balance.lost == numbers.fall_plans
    assert first.time < fallen
    _, made, _ = plans(stand, 0.4)
    assert not any(plan.status.falling for plan in made)


def told(margins, **keys):
    """Warnings of plans with such margins one after another."""
    numbers, found, balance = replace(P.recovery, **keys), [], Balance()
    for margin in margins:
        lost = balance.lost + 1 if margin < -numbers.fall_margin else 0
        safe = balance.safe + 1 if margin >= 0.0 else 0
        balance = Balance(movable=margin, lost=lost, safe=safe)
        found.append(falling(balance, bool(found) and found[-1], numbers))
    return found


OUT, NEAR, IN = -0.2, -0.05, 0.05
"""Margins of a fall, of none yet, and of a robot that can be saved [m]."""


def test_a_fall_is_told_after_so_many_plans_on_end_and_taken_back_after_so_many_with_margin():
    count, back = P.recovery.fall_plans, P.recovery.regained_plans
    assert told([OUT] * count) == [False] * (count - 1) + [True]
    assert not any(told([*[OUT] * (count - 1), NEAR] * 5))
    assert told([*[OUT] * count, *[NEAR] * 50])[-50:] == [True] * 50
    assert told([*[OUT] * count, *[IN] * (back - 1), NEAR, *[IN] * (back - 1)])[count:] == [True] * (2 * back - 1)
    assert told([*[OUT] * count, *[IN] * back, NEAR])[-3:] == [True, False, False]
    assert told([*[OUT] * count, *[IN] * back, *[OUT] * count])[-2:] == [False, True]
    assert told([OUT, IN, IN], fall_plans=1, regained_plans=2) == [True, True, False]


def test_a_planner_tells_what_its_margins_say(stand):
    """Counts are the same however the margins come about: here by a DCM that is lost and found again."""
    parameters, begin = replace(P, step_adaptation=StepAdaptation.NONE), GAIT.lift_off(3) + 0.25
    planner = WalkingPlanner(GAIT, stand(), 0.22, 0.11, parameters=parameters, legs=LEGS)
    com, feet, said, margins = np.array([0.0, 0.0, GAIT.com_height]), stand(), [], []
    for tick in range(60):
        astray = 10 <= tick < 20 or 40 <= tick < 42
        speed = np.array([0.0, 1.5 if astray else 0.0, 0.0])
        plan = planner.update(CentroidalState(tick * T, com, speed), feet)
        said.append(plan.status.falling)
        margins.append(plan.balance.movable)
    assert said == told(margins)
    assert begin > 60 * T  # it stands all the while
    assert np.flatnonzero(said).tolist() == list(
        range(10 + P.recovery.fall_plans - 1, 20 + P.recovery.regained_plans - 1)
    )


def test_shift_and_delay_are_of_one_landing(stand):
    """A plan goes on from those of the one before it, until that landing."""
    _, made, _ = plans(stand, 0.4)
    moved = [plan for plan in made if np.abs(plan.balance.shift).max() > 0.05]
    assert {plan.phase.landed for plan in moved} == {2}
    first = next(plan for plan in made if plan.phase.landed == 3)
    assert np.abs(first.balance.shift).max() < 1e-3


def test_with_a_time_of_its_own_a_step_captures_what_the_best_time_captures():
    """The best is now and then in the middle: earlier legs do not reach as far, later the DCM is away."""
    numbers, best = P.recovery, []
    own, given = margin_of(timing=True), margin_of()
    for x, y in np.random.default_rng(0).uniform((-0.1, -0.1), (0.4, 0.25), (40, 2)):
        now = replace(situation((x, y)), cycle=own.cycle)
        least = min(now.single, max(numbers.least_single, now.shortest))
        times = [*np.interp(numbers.margin_times, (0.0, 1.0), (least, now.single + numbers.longer)), now.single]
        each = np.array([given.margins(replace(now, single=time), 3) for time in times])
        np.testing.assert_allclose(own.margins(now, 3), each.max(axis=0), rtol=1e-12)
        best.append(times[int(each[:, 0].argmax())])
    assert len(set(best)) > 2
