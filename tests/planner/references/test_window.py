"""The offset table is used again by the value of its key, never because an object happens to be the same one."""

from dataclasses import replace

import numpy as np
import pytest
from pendulum_walk import walk_pendulum

from surefoot.forces import Push
from surefoot.planner.look import look
from surefoot.planner.measured import Measured
from surefoot.planner.model.dcm import viability_weights
from surefoot.planner.model.leg_chain import LegChain, Link
from surefoot.planner.model.time_scaling import TimeScaling
from surefoot.planner.parameters import LegInertia, PlannerParameters, RecoveryParameters
from surefoot.planner.planner import WalkingPlanner
from surefoot.planner.references.leg_offset import LegOffset
from surefoot.planner.references.offset_table import OffsetTable
from surefoot.planner.references.zmp_reference import SupportKey
from surefoot.planner.steps.gait import GaitParameters
from surefoot.planner.swing.leg_reach import LegReach
from surefoot.planner.types import CentroidalState

pytestmark = pytest.mark.unit

LINK = Link(0.4, 0.08, 0.45, 0.003)
LEG = LegInertia(0.06, LegChain(0.1, (0.0, 0.0, 0.25), LINK, LINK, 0.02, (0.03, 0.0, -0.05), (0.0, 0.0, 0.1)))
KEY = SupportKey(3, 2, 100.0, (True, False))


AIM = np.array([1.0, 0.2, 0.0])
CLOCK = TimeScaling(0.02).scaled(30.0, 20.0)


def table(aim=None):
    return OffsetTable(110, KEY, CLOCK.course, aim, np.arange(400.0).reshape(200, 2), 5)


def at(tick, clock=CLOCK):
    return replace(clock, ticks=tick)


def test_a_table_holds_for_few_later_ticks_of_an_equal_key():
    assert [tick for tick in range(105, 120) if table().holds(at(tick), SupportKey(*KEY), None, 0.005)] == [
        111, 112, 113, 114,
    ]  # fmt: skip
    np.testing.assert_array_equal(table().since(113, 150), table().values[3:153])


@pytest.mark.parametrize("change", [{"schedule": 4}, {"landed": 3}, {"phase_start": 101.0}, {"free": (True, True)}])
def test_a_table_does_not_hold_for_another_support(change):
    assert not table().holds(at(111), KEY._replace(**change), None, 0.005)


def test_a_table_does_not_hold_on_another_time_scaling():
    assert not table().holds(at(111, CLOCK.scaled(30.0, 25.0)), KEY, None, 0.005)
    assert not table().holds(at(111, TimeScaling(0.02)), KEY, None, 0.005)


def test_a_table_holds_for_a_swing_that_is_aimed_at_about_the_same_place():
    aside = np.array([0.0, 0.001, 0.0])
    assert table(AIM).holds(at(111), KEY, AIM + 4.0 * aside, 0.005)
    assert not table(AIM).holds(at(111), KEY, AIM + 6.0 * aside, 0.005)
    assert not table(AIM).holds(at(111), KEY, None, 0.005)
    assert not table().holds(at(111), KEY, AIM, 0.005)


class Recorded:
    """A planner that keeps what it is given, and whether it adapted a swing then."""

    def __init__(self, planner):
        self.planner, self.parameters, self.given = planner, planner.parameters, []

    def update(self, state, feet):
        plan = self.planner.update(state, feet)
        self.given.append((state, feet, self.planner.state.aim is not None))
        return plan


def test_an_offset_that_serves_is_about_what_it_would_be_anew(stand):
    """The difference is in the DCM, while a step is adapted; and the offset does serve for most ticks.

    The later a footstep moves, the harder and the shorter its foot is pushed there, which moves the DCM no farther.
    """
    gait = GaitParameters(steps=3, step_length=0.3, single_support=0.5, double_support=0.12, com_height=0.95)
    legs, made = LegReach(0.36, 0.2, 0.115, 0.12, 0.24, (60.0, 50.0)), []

    class Counted(LegOffset):
        """An offset of which it is counted how often it is made."""

        def made(self, moving, *given):
            made.append(moving[-1] is not None)
            return super().made(moving, *given)

    def planner(**numbers):
        parameters = PlannerParameters(leg=LEG, recovery=RecoveryParameters(**numbers))
        walking = WalkingPlanner(gait, stand(), 0.22, 0.11, parameters=parameters, legs=legs)
        model, toe = walking.state.model, 0.11
        offset = Counted(parameters.leg, toe, parameters.sample_time, model.reach)
        walking.state = replace(walking.state, model=replace(model, leg_offset=offset))
        return Recorded(walking)

    usual, push = planner(), Push(gait.lift_off(2) + 0.06, 0.1, np.array([250.0, 0.0, 0.0]))
    end, com = gait.lift_off(2) + 0.48, np.array([0.0, 0.0, 0.95])
    plans = walk_pendulum(usual, stand(), end, com=com, pushes=(push,)).plans
    assert 10 < sum(adapts for *_, adapts in usual.given) > 2 * sum(made)
    anew, apart = planner(offset_ticks=1), []
    stiffness = np.full(len(plans[0].zmp_offset), 9.81 / gait.com_height)
    weights = viability_weights(stiffness, np.sqrt(stiffness), usual.parameters.sample_time)
    for plan, (state, feet, adapts) in zip(plans, usual.given, strict=True):
        other = anew.update(state, feet)
        apart += [np.abs(weights @ (other.zmp_offset - plan.zmp_offset)).max()] * adapts
    assert max(np.abs(weights @ plan.zmp_offset).max() for plan in plans) > 0.01
    assert 0.0 < max(apart) < 1e-3


@pytest.mark.parametrize("copied", [False, True])
def test_plans_depend_on_values_and_not_on_objects(stand, copied):
    """A schedule replaced by an equal one changes no plan; moved steps do, even one that was fixed before."""
    gait = GaitParameters(steps=2, initial_stand=0.0)
    plans = []
    for change in (False, True):
        planner = WalkingPlanner(gait, stand(), 0.2, 0.1, parameters=PlannerParameters(leg=LEG))
        for tick in range(4):
            place = planner.schedule.step(1).place.position
            if tick == 1:
                planner.state = planner.state.deciding(place)
            if change and tick == 2:
                if copied:
                    planner.state = replace(planner.state, schedule=replace(planner.schedule))
                else:
                    planner.state = planner.state.deciding(place + np.array([0.05, 0.0, 0.0]))
            state = CentroidalState(0.02 * tick, np.array([0.001 * tick, 0.0, 1.0]), np.zeros(3))
            plan = planner.update(state, stand())
        plans.append(plan)
    same = np.array_equal(plans[0].zmp_offset, plans[1].zmp_offset)
    assert same is copied
    assert np.abs(plans[0].zmp_offset).max() > 1e-3


def test_a_window_stays_as_it_was_when_the_next_one_is_looked_at(stand):
    planner = WalkingPlanner(GaitParameters(steps=3), stand(), 0.2, 0.1, parameters=PlannerParameters(leg=LEG))
    windows, kept, state = [], [], planner.state
    for tick in range(2):
        state = replace(state, clock=replace(state.clock, now=60.0 + tick, ticks=tick))
        body = CentroidalState(0.02 * tick, np.array([0.0, 0.0, 1.0]), np.zeros(3))
        view = look(state, Measured(body, stand()))
        windows.append(view.window)
        state = view.state
        names = ("offset", "stiffness", "omega", "load_left", "contacts")
        kept.append({name: getattr(windows[0], name).copy() for name in names})
        kept[tick]["height"], kept[tick]["point"] = windows[0].height.height.copy(), windows[0].driving.point.copy()
    assert not np.array_equal(windows[0].height.height, windows[1].height.height)
    for name, value in kept[0].items():
        np.testing.assert_array_equal(kept[1][name], value)


def test_a_table_tells_about_what_the_next_one_will_be():
    """Its values from the tick on, and its last one beyond; nothing of another support or when it is over."""
    values = table().values
    np.testing.assert_array_equal(table().guess(113, KEY, 150), values[3:153])
    guessed = table().guess(290, KEY, 50)
    np.testing.assert_array_equal(guessed[:20], values[180:])
    np.testing.assert_array_equal(guessed[20:], np.tile(values[-1], (30, 1)))
    assert table().guess(310, KEY, 50) is None and table().guess(113, KEY._replace(landed=3), 50) is None
