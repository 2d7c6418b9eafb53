"""The CoM height of another robot is that at which its straightest knee is bent as the first one's."""

import pytest

from surefoot.scenarios.setup.load import load
from surefoot.scenarios.setup.robot.body import body_of
from surefoot.scenarios.setup.robot.robots import Robots
from surefoot.scenarios.setup.stances.stances import bent_alike, bent_once, least_bend
from surefoot.scenarios.setup.walk import resolve

pytestmark = pytest.mark.unit


def bend(name: str, **values: object) -> float | None:
    walk = resolve(load(name, values))
    return least_bend(walk, body_of(walk.robot))


@pytest.mark.parametrize("name", ["walk-level", "paper-walk"])
@pytest.mark.parametrize("robot", ["talos", "g1", "alexander"])
def test_a_catalogue_walk_bends_the_knees_of_any_robot_alike(name: str, robot: str) -> None:
    # 0.1 mm of height, to which it is rounded, is a few mrad of a knee that is nearly straight.
    assert bend(name, robot=robot) == pytest.approx(bend(name), abs=0.005)


def test_a_height_that_is_set_is_literal() -> None:
    settings = {"robot": "talos", "gait.com_height": 0.8}
    assert load("walk-level", settings).gait.com_height == 0.8
    assert bend("walk-level", **settings) > bend("walk-level", robot="talos") + 0.05


def test_the_height_that_is_found_does_not_hang_on_the_one_begun_with() -> None:
    of, walk = load("walk-level"), load("walk-level", {"robot": "talos"})
    for off in (-0.02, 0.01):
        begun = walk.model_copy(
            update={"gait": walk.gait.model_copy(update={"com_height": walk.gait.com_height + off})}
        )
        assert bent_alike(of, begun, Robots()) == pytest.approx(walk.gait.com_height, abs=1.5e-4)


def test_where_no_height_near_makes_them_alike_it_stays() -> None:
    of = load("walk-level", {"gait.com_height": 0.7})
    walk = load("walk-level", {"robot": "talos"})
    assert bent_alike(of, walk, Robots()) == walk.gait.com_height


def test_a_walk_whose_steps_are_not_known_beforehand_keeps_its_height() -> None:
    of, walk = load("commanded"), load("commanded", {"robot": "talos"})
    assert least_bend(resolve(of), body_of(resolve(of).robot)) is None
    assert bent_alike(of, walk, Robots()) == walk.gait.com_height


def test_what_befalls_a_walk_and_how_it_recovers_move_no_stance() -> None:
    """So the campaigns that vary it ask for one height."""
    pushes = [{"step": 2, "phase": "single", "fraction": 0.5, "duration": 0.1, "impulse": 0.3, "direction": 1.0}]
    numbers = {"planner.recovery.second_weight": 0.5, "planner.recovery.landing_share": 1.0}
    assert bend("walk-level", robot="talos", pushes=pushes, criteria={"fell": False}, **numbers) == bend(
        "walk-level", robot="talos"
    )
    robots, of = Robots(), load("walk-level")
    plain = load("walk-level", {"robot": "talos", "planner.recovery.cross_factor": 2.0})
    pushed = load("walk-level", {"robot": "talos", "pushes": pushes, **numbers})
    assert bent_once(of, pushed, robots) is bent_once(of, plain, robots)
    wider = load("walk-level", {"robot": "talos", "planner.recovery.sole_gap": 0.02})
    assert bent_once(of, wider, robots) is not bent_once(of, plain, robots)
