"""The place and the time of a step after a push, held against the pendulum's own motion."""

import math
from dataclasses import replace

import numpy as np
import pytest
from pendulum_walk import LEGS
from pushed_step import PushedStep

from surefoot.planner.geometry.plane import quintic
from surefoot.planner.model.dcm import viability_weights
from surefoot.planner.model.pendulum import com_after
from surefoot.planner.parameters import PlannerParameters, RecoveryParameters, StepAdaptation
from surefoot.planner.recovery.reach import StepReach
from surefoot.planner.recovery.step_adjustment import StepAdjustment
from surefoot.planner.references.com_height import HeightPreview
from surefoot.planner.references.window import Window
from surefoot.planner.references.zmp_reference import ZmpReference
from surefoot.planner.swing.leg_reach import ANYWHERE
from surefoot.planner.types import Foot, Footstep

pytestmark = pytest.mark.unit

P = PlannerParameters()
T, OMEGA = P.sample_time, 3.2
NOMINAL = np.array([0.36, 0.2])
PLACE = Footstep(Foot.LEFT, np.append(NOMINAL, 0.0), 0.0)
HALF = np.array([0.1, 0.05])
LIFTING = P.recovery.lifting


def situation(error=(0.0, 0.0), single=0.3, half=HALF, swing=((0.1, 0.2), (1.0, 0.0)), **keys):
    """A left step on the right foot: its DCM is off the nominal one by an error [m]."""
    count = P.horizon + P.preview + 1
    landed = round(single / T) * T
    times = T * np.arange(count)
    share = np.clip((times - landed) / 0.12, 0.0, 1.0)
    point, gain = share[:, None] * NOMINAL, np.column_stack((share, np.zeros(count)))
    reference = ZmpReference(point, gain, np.broadcast_to(half, (count, 2)), np.zeros(count), np.zeros((count, 2)))
    stiffness, omega = np.full(count, OMEGA**2), np.full(count, OMEGA)
    bounded = viability_weights(stiffness, omega, T) @ point
    given = {
        "com": bounded - (0.1, 0.0), "dcm": bounded + error,
        "window": Window(reference, reference, point, HeightPreview(np.ones((3, count)), stiffness), stiffness, omega,
                         omega, point > 0.0),
        "place": PLACE, "swing": np.array(swing), "double": 0.0,
        "single": landed, "cycle": 0.62, "shortest": 0.0, "face": ANYWHERE,
        "adapted": False, "last": False, "crosses": True,
    }  # fmt: skip
    return PushedStep(**{**given, **keys})


def adjusted(now, timing=True, legs=LEGS, uncertainty=0.0):
    parameters = P if timing else replace(P, step_adaptation=StepAdaptation.LOCATION)
    return StepAdjustment(legs, parameters).solve(now.com, now.dcm, now.window, now, uncertainty)


@pytest.mark.parametrize("error", [(0.0, 0.0), (0.08, 0.0), (-0.05, 0.03), (0.0, -0.04)])
def test_without_need_nothing_is_adapted(error):
    """The CoP holds (e^{ωT} - 1) / e^{ωT} of its box until the landing: 62 % of 0.1 and 0.05 m."""
    held = (1.0 - np.exp(-OMEGA * 0.3)) * HALF + 0.02 * np.exp(-OMEGA * 0.3)
    assert (adjusted(situation(error)) is None) is bool((np.abs(error) <= held).all())
    assert adjusted(situation(0.999 * held)) is None
    assert adjusted(situation(1.001 * held)) is not None


def test_an_error_that_may_be_one_of_the_estimate_moves_no_step():
    """As far as the DCM is unsure; beyond it steps move as ever."""
    held = (1.0 - np.exp(-OMEGA * 0.3)) * HALF + 0.02 * np.exp(-OMEGA * 0.3)
    for error in (1.001 * held, 0.999 * (held + 0.01)):
        assert adjusted(situation(error)) is not None
        assert adjusted(situation(error), uncertainty=0.01) is None
    assert adjusted(situation(held + 0.0101), uncertainty=0.01) is not None


def test_who_stands_on_both_feet_has_the_room_between_them():
    """Until the foot lifts off: the weights of that room in the DCM now count as all others do."""
    fade, now = np.exp(-OMEGA * 0.5), situation()
    lifts, wide = round(0.2 / T), np.tile(HALF, (len(now.window.stiffness), 1))
    wide[:lifts] += (0.0, 0.1)
    more = viability_weights(now.window.stiffness, now.window.omega, T) @ (wide - HALF)
    held = (1.0 - fade) * HALF + 0.02 * fade
    starting = {"double": 0.2, "half": wide}
    assert adjusted(situation(1.001 * held, double=0.2)) is not None
    assert adjusted(situation(0.999 * (held + more), **starting)) is None
    assert adjusted(situation(1.01 * (held + more), **starting)) is not None


def test_a_step_that_is_adapted_counts_on_four_fifths_of_the_room_between_the_feet():
    """Until the foot lands what the CoP does with it has grown by e^{ωT}, and moves the step the less.

    The ZMP of this situation is all on the new foot when that lands, so that a shift counts as it is.
    """
    free, error = replace(LEGS, radius=4.0, near=-4.0, across=None, acceleration=(1e4, 1e4)), (0.0, 0.25)
    now = situation()
    lifts, wide = round(0.2 / T), np.tile(HALF, (len(now.window.stiffness), 1))
    wide[:lifts] += (0.0, 0.1)
    more = viability_weights(now.window.stiffness, now.window.omega, T) @ (wide - HALF)
    caught = [adjusted(situation(error, double=0.2, half=half), False, free) for half in (HALF, wide)]
    narrow, broad = (0.5 * (one.box[0] + one.box[1]) for one in caught)
    np.testing.assert_allclose(narrow - broad, 0.8 * np.exp(OMEGA * 0.5) * more, atol=2e-3)


@pytest.mark.parametrize("share", [0.3, 0.5])
@pytest.mark.parametrize("error", [(0.08, 0.0), (-0.06, 0.0), (0.0, 0.06), (0.05, 0.05)])
def test_the_place_leaves_no_error_that_the_cop_cannot_hold(error, share):
    """The pendulum with its CoP at the edge until the foot lands.

    The box is what legs reach level with that place, and leaves half of what the next CoP has of its box.
    """
    free = replace(LEGS, radius=2.0, near=-2.0, across=None, acceleration=(1e4, 1e4))
    half = share * HALF
    now = situation(error, half=half)
    caught = adjusted(now, timing=False, legs=free)
    assert caught.left == now.single
    nominal, most = situation().dcm * np.exp(OMEGA * now.single), 0.8 * half
    astray = now.dcm * np.exp(OMEGA * now.single) - nominal
    cop = np.clip(astray / (np.exp(OMEGA * now.single) - 1.0), -most, most)
    landed = cop + (now.dcm - cop) * np.exp(OMEGA * now.single)
    # Double support takes 0.12 s, in which the ZMP goes over to the foot: a shift counts as the mean fade of that time.
    gain = (1.0 - np.exp(-OMEGA * 0.12)) / (OMEGA * 0.12)
    place = NOMINAL + (landed - nominal) / gain
    grown = np.exp(OMEGA * now.single)
    com = [com_after(*here, grown) for here in zip(now.com, now.dcm, cop, strict=True)]
    hip = np.array(com) + np.array([0.0, 0.1])
    low, high = free.around(place, hip, free.allowed(1.0, ANYWHERE, True)[0], free.radius)
    held = np.maximum(0.5 * most, half - 0.03) / gain
    low, high = np.maximum(low, place - held), np.minimum(high, place + held)
    np.testing.assert_allclose((caught.box[0], caught.box[1]), (low, high), atol=3e-3)


@pytest.mark.parametrize("error", [0.1, 0.2])
def test_a_foot_that_does_not_get_far_enough_lands_as_far_as_it_gets(error):
    """Anywhere nearer to its nominal place the DCM would be beyond what the next foot holds."""
    caught = adjusted(situation((error, 0.0), single=0.25, half=0.2 * HALF), timing=False)
    assert caught.box[0, 0] == caught.box[1, 0] > NOMINAL[0] + 0.05


def test_a_foot_is_swung_no_harder_than_the_hip_allows():
    now = situation((0.25, 0.0), single=0.2, swing=((0.1, 0.2), (1.0, 0.0)))
    caught = adjusted(now, timing=False, legs=replace(LEGS, radius=2.0))
    time, bends = now.single - P.touchdown_lead, []
    for corner in (caught.box[0, 0], caught.box[1, 0]):
        start, end = np.array([[0.1], [1.0], [0.0]]), np.array([[corner], [0.0], [0.0]])
        at = np.linspace(0.0, time, 200)[:, None] ** np.arange(4)
        bends.append(np.abs(at @ (np.arange(2, 6) * np.arange(1, 5) * quintic(start, end, time)[2:, 0])).max())
    assert max(bends) < 1.03 * LEGS.acceleration[0]
    assert bends[1] > 0.9 * LEGS.acceleration[0]


@pytest.mark.parametrize("behind", [0.5, 0.75])
def test_a_step_is_not_hurried_to_a_place_that_its_foot_cannot_be_swung_to(behind):
    """With the DCM far ahead: nobody gets across the stance leg, 0.24 m ahead of it, in the 0.18 s that would do."""
    now = situation((0.25, 0.0), 0.38, swing=((-behind, 0.2), (0.3, 0.0)))
    caught = adjusted(now)
    reach = StepReach(LEGS)
    reach.see(now)
    front = reach.swung(0, 1.0, caught.left)
    assert caught.box[0, 0] <= front


@pytest.mark.parametrize("direction", np.linspace(-np.pi, np.pi, 12, endpoint=False))
@pytest.mark.parametrize("single", [0.1, 0.3, 0.8])
def test_the_box_is_in_reach_of_the_legs(direction, single):
    error = 0.3 * np.array([np.cos(direction), np.sin(direction)])
    for legs in (LEGS, replace(LEGS, across=None)):
        caught = adjusted(situation(error, single), legs=legs)
        assert (caught.box[0] <= caught.box[1]).all()
        assert (np.abs(caught.box[0]) <= 2.0 * legs.radius + legs.hip_width).all()
        for x in (caught.box[0, 0], caught.box[1, 0]):
            assert caught.box[0, 1] >= legs.near - 1e-9 or (abs(x) >= legs.clear - 1e-9 and legs.across is not None)


def test_who_is_pushed_over_the_stance_foot_crosses_where_it_may():
    now = situation((0.0, -0.1), 0.4, swing=((0.2, 0.2), (1.5, 0.0)))
    crossing, beside = adjusted(now), adjusted(now, legs=replace(LEGS, across=None))
    assert crossing.box[0, 1] < 0.0
    assert beside.box[0, 1] >= LEGS.near - 1e-9


@pytest.mark.parametrize("turn", [0.0, 0.3])
def test_a_foot_that_turns_lands_the_farther_beside_its_stance_foot(turn):
    """Pushed over the stance foot: one that lands on it would be held off it in the air."""
    legs = replace(LEGS, across=None, sole=(0.22, 0.11))
    now = situation((0.0, -0.1), 0.4, swing=((0.0, 0.2), (0.0, 0.0)), place=replace(PLACE, yaw=turn))
    caught = adjusted(now, legs=legs)
    assert caught.box[0, 1] == pytest.approx(legs.turned(turn).near)
    assert legs.turned(0.3).near > legs.near + 0.025


def test_a_step_that_legs_cannot_make_long_enough_is_made_sooner():
    slow = {"single": 1.0, "swing": ((-0.3, 0.2), (0.0, 0.0))}
    assert adjusted(situation((0.14, 0.0), **slow)).left < 0.9
    assert adjusted(situation((0.14, 0.0), **slow), timing=False).left == 1.0


def test_a_double_support_ends_sooner_for_who_is_far_ahead_of_its_feet():
    now = situation((0.12, 0.0), 0.5, double=0.4, swing=((-0.36, 0.2), (0.0, 0.0)))
    assert adjusted(now).left < 0.3


@pytest.mark.parametrize(("error", "double"), [((-0.1, 0.0), 0.02), ((-0.1, -0.1), 0.1)])
def test_a_double_support_is_put_off_only_by_the_plan_that_first_adapts_its_step(error, double):
    """Near its end the clock gives less than is asked for: asked for again in every plan it would never end."""
    now = {"error": error, "single": 0.5, "double": double, "swing": ((-0.36, 0.2), (0.0, 0.0))}
    assert adjusted(situation(**now)).left > double
    assert adjusted(situation(**now, adapted=True)).left == double


def test_a_step_that_stays_on_its_tread_lands_sooner_within_it():
    room = np.array([[-0.02, -0.4], [0.02, 0.4]])
    now = situation((0.12, 0.04), 0.5, face=NOMINAL + room)
    caught = adjusted(now)
    assert caught.left < 0.5
    assert (caught.box[0] >= NOMINAL + room[0] - 1e-12).all()
    assert (caught.box[1] <= NOMINAL + room[1] + 1e-12).all()
    assert adjusted(situation((0.12, 0.04), 0.5, face=NOMINAL + room, shortest=0.45)).left >= 0.45


def test_a_step_that_lands_after_the_window_has_a_place_too():
    """A shift of it does nothing to any DCM in sight: its place is not divided by that."""
    with np.errstate(all="raise"):
        caught = adjusted(situation((0.2, 0.0), single=5.0), timing=False)
    assert np.isfinite(caught.box).all()
    assert (caught.box[0] <= caught.box[1]).all()


def test_no_foot_crosses_where_the_stance_leg_lets_the_body_down():
    pushed = {"error": (0.0, -0.12), "swing": ((-0.2, 0.2), (1.0, 0.0))}
    crossing, down = adjusted(situation(**pushed)), adjusted(situation(**pushed, crosses=False))
    assert crossing.box[0, 1] < 0.0
    assert down.box[0, 1] >= LEGS.near - 1e-9


@pytest.mark.parametrize(
    ("changes", "cut"),
    [((-0.2, -0.6, 0.1), 0.6), ((0.1, 0.2), math.inf), ((), math.inf)],
    ids=["cuts", "none", "empty"],
)
def test_the_longest_cut_is_that_of_the_changes(changes, cut):
    """Without a cut it is infinite: then a long time is changed from itself on."""
    assert replace(RecoveryParameters(), time_changes=changes).longest_cut == cut
