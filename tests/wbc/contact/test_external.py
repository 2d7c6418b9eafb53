"""External forces beside ground and gravity, from momentum and soles, and the controller's use of them."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pinocchio as pin
import pytest

from surefoot.similarity import REFERENCE_SIZE, Similarity
from surefoot.wbc.body.model import BodyFrames, RobotTerms
from surefoot.wbc.contact.external import PAST, LoadObserver
from surefoot.wbc.types import GRAVITY, NO_LOAD, ExternalLoad, FootSensing

pytestmark = pytest.mark.unit

PERIOD, MASS = 0.002, 100.0
FORCE, MOMENT = np.array([-30.0, 20.0, 0.0]), np.array([-9.0, -12.0, 5.0])
LOAD = ExternalLoad(FORCE, MOMENT, 1.15)


def terms_of_one_body():
    """Terms to be written by hand; at first nothing moves, and the left foot's wrench is that about the origin."""
    model, here = pin.Model(), pin.SE3.Identity()
    joint = model.addJoint(0, pin.JointModelFreeFlyer(), here, "base")
    model.appendBodyToJoint(joint, pin.Inertia(MASS, np.zeros(3), np.eye(3)), here)
    for name in ("left", "right", "torso"):
        model.addFrame(pin.Frame(name, joint, 0, here, pin.FrameType.OP_FRAME))
    terms = RobotTerms(model, BodyFrames(("left", "right"), "torso"))
    terms.com[:], terms.com_velocity[:], terms.angular_momentum[:] = 0.0, 0.0, 0.0
    terms.sole_wrench_map[:] = np.hstack((np.eye(6), np.zeros((6, 6))))
    return terms


def observed(
    scale=1.0, pull=lambda time: np.zeros(3), duration=1.0, fault=None, unsure=None, late=0, told=0.0,
    size=REFERENCE_SIZE,
):  # fmt: skip
    """Loads at every tick of a body, far from the origin, that its feet shake and that is pulled 0.8 m over its CoM.

    What the feet feel is told so many ticks late, with an age in ticks.
    """
    rng, observer, loads, wrenches = np.random.default_rng(5), LoadObserver(MASS, PERIOD, size), [], []
    terms = terms_of_one_body()
    mass, weight = scale * MASS, np.array([0.0, 0.0, -scale * MASS * GRAVITY])
    com, momentum = np.array([40.0, -7.0, 1.0]), np.array([20.0, -30.0, 5.0])
    spin = np.cross(com, momentum)
    for tick in range(round(duration / PERIOD)):
        ground, acting = rng.normal(scale=(200.0, 200.0, 300.0)) - weight, pull(tick * PERIOD)
        point, torque = com + rng.normal(scale=0.2, size=3), rng.normal(scale=20.0, size=3)
        felt = np.concatenate((ground, np.cross(point, ground) + torque))
        if tick:
            before = momentum
            momentum = momentum + PERIOD * (ground + weight + acting)
            com = com + PERIOD * 0.5 * (momentum + before) / mass
            lever = com + np.array([0.0, 0.0, 0.8])
            spin = spin + PERIOD * (felt[3:] + np.cross(com, weight) + np.cross(lever, acting))
        turning = (spin - np.cross(com, momentum)) / scale
        terms.com[:], terms.com_velocity[:], terms.angular_momentum[:] = com, momentum / mass, turning
        wrenches.append(np.concatenate((felt, np.zeros(6))).reshape(2, 6))
        wrench = wrenches[max(tick - late, 0)]
        deviation = (0.0, 0.0) if unsure is None else unsure(tick * PERIOD)
        wrench = wrench if fault is None else fault(tick, wrench)
        loads.append(observer.update(terms, wrench, deviation, told * PERIOD))
    return loads


@pytest.mark.parametrize("scale", [0.75, 1.0, 1.25])
def test_the_observer_finds_a_lasting_force_its_moment_and_the_weight_however_the_body_is_shaken(scale):
    load = observed(scale, lambda time: np.array([40.0, -15.0, 0.0]))[-1]
    np.testing.assert_allclose(load.force, [40.0, -15.0, 0.0], atol=0.1)
    np.testing.assert_allclose(load.moment, [12.0, 32.0, 0.0], atol=0.1)
    assert load.mass_scale == pytest.approx(scale, abs=1e-6)


@pytest.mark.parametrize("late", [1, 3, 70])
def test_forces_that_are_told_late_are_held_against_the_motion_of_their_time(late):
    """Against that of now they are moments that nobody exerts; beyond what is remembered they are, too."""
    loads = observed(pull=lambda time: np.array([40.0, -15.0, 0.0]), late=late, told=late)
    if late < PAST:
        np.testing.assert_allclose(loads[-1].force, [40.0, -15.0, 0.0], atol=0.1)
        np.testing.assert_allclose(loads[-1].moment, [12.0, 32.0, 0.0], atol=0.2)
    # The first wrenches are told of more ticks than one.
    quiet, taken_for_new = observed(late=late, told=late)[100:], observed(late=late)[100:]
    assert all(load is NO_LOAD for load in quiet) == (late < PAST)
    assert max(np.abs(load.moment).max() for load in taken_for_new) > 10.0


@pytest.mark.parametrize("told", [PAST - 1, PAST, 10 * PAST])
def test_an_age_beyond_what_is_remembered_is_that_of_the_oldest(told):
    pull, oldest = lambda time: np.array([40.0, -15.0, 0.0]), PAST - 2
    found, wanted = (observed(pull=pull, late=oldest, told=age)[-1] for age in (told, oldest))
    np.testing.assert_allclose(found.force, wanted.force)
    np.testing.assert_allclose(found.moment, wanted.moment)
    np.testing.assert_allclose(found.force, [40.0, -15.0, 0.0], atol=0.1)


@pytest.mark.parametrize("told", [np.nan, -3.0])
def test_an_age_that_is_no_time_is_none(told):
    found, wanted = observed(told=told), observed()
    np.testing.assert_array_equal([load.mass_scale for load in found], [load.mass_scale for load in wanted])


def test_between_two_ticks_the_motion_is_as_far_from_each_as_the_age_says():
    """A push of the feet that grows evenly tells 1.5 ticks from 1 and from 2."""
    found, terms = {}, terms_of_one_body()
    for told in (1.0, 1.5, 2.0):
        observer = LoadObserver(MASS, PERIOD)
        for tick in range(40):
            now, then = tick * PERIOD, (tick - 1.5) * PERIOD
            # Of forces at the ends of ticks a mean is half a tick younger than the momentum: the last rows take it out.
            momentum = np.array([500.0 * now * now + 500.0 * PERIOD * now, 0.0, 0.0])
            terms.com_velocity[:] = momentum / MASS
            wrench = np.zeros((2, 6))
            wrench[0, [0, 2]] = 1000.0 * then, MASS * GRAVITY
            observer.update(terms, wrench, (0.0, 0.0), told * PERIOD)
        found[told] = observer.found[0]
    np.testing.assert_allclose([found[told] for told in (1.0, 1.5, 2.0)], [1.0, 0.0, -1.0], atol=1e-9)


def test_the_weight_is_known_within_a_tenth_of_a_second_and_never_jumps():
    scales = np.array([load.mass_scale for load in observed(1.15, duration=0.2)])
    assert scales[50] == pytest.approx(1.15)
    assert np.abs(np.diff(scales)).max() <= 0.04 + 1e-12


@pytest.mark.parametrize(("force", "time"), [(600.0, 0.1), (60.0, 0.11)])
def test_of_a_push_little_counts_and_nothing_when_it_is_over(force, time):
    loads = observed(pull=lambda now: np.array([force, -force, 0.0]) * (0.413 <= now < 0.413 + time))
    assert max(np.abs(load.force).max() for load in loads) <= 40.0
    assert max(np.abs(load.moment).max() for load in loads) <= 12.0
    over = round((0.413 + time + 0.12) / PERIOD)
    assert all(load is NO_LOAD for load in (*loads[:206], *loads[over:]))


def test_a_force_counts_soon_wholly_when_it_lasts_and_no_longer_than_it_acts():
    """One that is as hard as a push only once it has lasted longer than one."""
    for pull, soon in ((48.0, 40.0), (90.0, 0.0)):
        loads = observed(pull=lambda now, pull=pull: np.array([pull, 0.0, 0.0]) * (0.4 <= now < 0.9), duration=1.2)
        force = np.array([load.force[0] for load in loads])
        assert force[: round(0.4 / PERIOD)].max() == 0.0
        assert force[round(0.5 / PERIOD)] == pytest.approx(soon)
        np.testing.assert_allclose(force[round(0.65 / PERIOD) : round(0.9 / PERIOD)], pull, atol=0.1)
        assert np.abs(force[round(1.05 / PERIOD) :]).max() == 0.0
        assert np.abs(np.diff(force)).max() <= 20.0 + 1e-9


def test_nobody_leans_into_a_push():
    loads = observed(pull=lambda now: np.array([70.0, 60.0, 0.0]) * (0.4 <= now < 0.5), duration=0.8)
    assert all(load is NO_LOAD for load in loads)


@pytest.mark.parametrize("tick", range(200, 210))
def test_a_push_lasts_no_longer_for_a_small_robot(tick):
    """Half of spans that followed its size would last 0.09 s: 0.1 s of a push were taken for a force that lasts."""
    begins, ends = (tick - 0.5) * PERIOD, (tick + 49.5) * PERIOD
    push, small = np.array([0.0, 75.0, 0.0]), Similarity(length=0.6, mass=0.33)
    assert small.time < 0.8
    loads = observed(pull=lambda now: push * (begins < now < ends), duration=0.8, size=small)
    assert all(load is NO_LOAD for load in loads)


@pytest.mark.parametrize("tick", range(200, 210))
def test_the_spans_in_which_a_push_begins_and_ends_tell_no_smaller_force(tick):
    begins, ends = (tick - 0.5) * PERIOD, (tick + 49.5) * PERIOD
    loads = observed(pull=lambda now: np.array([0.0, -180.0, 0.0]) * (begins < now < ends), duration=0.8)
    assert all(load is NO_LOAD for load in loads)


def test_what_is_short_and_small_is_none():
    loads = observed(pull=lambda now: np.array([9.0, 9.0, 0.0]) * (0.4 <= now < 0.5))
    assert all(load is NO_LOAD for load in loads)


@pytest.mark.parametrize("scale", [0.991, 1.009])
def test_what_is_small_is_none(scale):
    assert all(load is NO_LOAD for load in observed(scale, lambda time: np.array([2.7, -2.7, 0.0])))


def test_readings_that_are_no_numbers_and_flight_tell_nothing():
    def pull(time):
        return np.array([40.0, 0.0, 0.0])

    def broken(tick, wrench):
        return np.full_like(wrench, np.nan) if tick in (300, 301) else wrench

    assert observed(pull=pull, fault=broken)[-1].force[0] == pytest.approx(40.0, abs=0.1)
    flying = observed(1.0, fault=lambda tick, wrench: 0.0 * wrench)
    assert {load.mass_scale for load in flying} == {1.0}


def test_limits_widen_with_how_unsure_state_and_wrenches_are():
    """A force that counts where all is known does not count where it may be noise; a greater one does."""

    def lasting(force, deviation):
        loads = observed(
            pull=lambda time: np.array([force, 0.0, 0.0]), unsure=None if deviation is None else lambda _: deviation
        )
        return loads[-1].force[0]

    assert lasting(15.0, None) == lasting(15.0, (0.0, 0.0)) == pytest.approx(15.0, abs=0.1)
    # As the root of the sum of squares: of 12 N and 4 N nothing counts below 12.65 N, of 24 N and 8 N all above 25.3 N.
    assert lasting(12.0, None) == pytest.approx(12.0, abs=0.1) and lasting(12.0, (12.0, 1.0)) == 0.0
    assert 0.0 < lasting(14.0, (12.0, 1.0)) < lasting(22.0, (12.0, 1.0)) < 22.0
    assert lasting(26.0, (12.0, 1.0)) == pytest.approx(26.0, abs=0.1)
    assert 0.0 < lasting(22.0, (12.0, 1.0)) < 22.0
    assert lasting(40.0, (12.0, 1.0)) == pytest.approx(40.0, abs=0.1)


def test_nothing_is_found_before_the_wrenches_are_known():
    """Then what lasts is found after as many spans as ever, and the first ones have no say."""
    start = 0.5
    loads = observed(
        1.1,
        pull=lambda time: np.array([60.0, 0.0, 0.0]),
        unsure=lambda time: (np.inf, np.inf) if time < start else (1.0, 1.0),
        fault=lambda tick, wrench: wrench if tick * PERIOD >= start else 3.0 * wrench,
    )
    known = round((start + 0.24) / PERIOD)
    assert all(load is NO_LOAD for load in loads[:known])
    assert loads[-1].force[0] == pytest.approx(60.0, abs=0.1) and loads[-1].mass_scale == pytest.approx(1.1)


def scaled(model, factor):
    other = pin.Model(model)
    for k, inertia in enumerate(model.inertias):
        other.inertias[k] = pin.Inertia(factor * inertia.mass, inertia.lever, factor * inertia.inertia)
    return other


def test_a_robot_that_bears_weight_is_one_with_heavier_bodies(robot, rng):
    state = robot.moved(rng, 0.3, 1.0)
    terms, heavy = RobotTerms(robot.model, robot.frames), RobotTerms(scaled(robot.model, 1.15), robot.frames)
    terms.update(state.q, state.v)
    heavy.update(state.q, state.v)
    terms.bear(replace(NO_LOAD, mass_scale=1.15))
    np.testing.assert_allclose(terms.mass_matrix, heavy.mass_matrix, atol=1e-9)
    np.testing.assert_allclose(terms.bias, heavy.bias, atol=1e-9)
    assert terms.mass == pytest.approx(heavy.mass)
    np.testing.assert_allclose(terms.com_velocity, heavy.com_velocity, atol=1e-12)


def test_a_load_does_the_work_of_its_force_and_moment_on_the_torso(robot, rng):
    state = robot.moved(rng, 0.3, 1.0)
    terms = RobotTerms(robot.model, robot.frames)
    terms.update(state.q, state.v)
    free = terms.bias.copy()
    turning = terms.torso_rotation @ terms.torso_velocity
    frame = robot.model.getFrameId(robot.frames.torso)
    moving = pin.getFrameVelocity(robot.model, terms.data, frame, pin.ReferenceFrame.LOCAL_WORLD_ALIGNED).linear
    at_com = moving + np.cross(turning, terms.com - terms.torso_position)
    terms.bear(replace(LOAD, mass_scale=1.0))
    assert (free - terms.bias) @ state.v == pytest.approx(FORCE @ at_com + MOMENT @ turning)


def test_an_update_ends_a_load(robot, rng):
    state = robot.moved(rng)
    used, fresh = RobotTerms(robot.model, robot.frames), RobotTerms(robot.model, robot.frames)
    used.update(state.q, state.v)
    used.bear(LOAD)
    used.update(state.q, state.v)
    fresh.update(state.q, state.v)
    assert (used.mass, used.load) == (fresh.mass, NO_LOAD)
    np.testing.assert_array_equal(used.mass_matrix, fresh.mass_matrix)
    np.testing.assert_array_equal(used.bias, fresh.bias)


def test_the_controller_moves_a_loaded_robot_as_an_unloaded_one(robot, references):
    """The soles carry the load beside the motion by Newton and Euler, which is about the same in both."""
    answers = []
    # The point that drives the pendulum stays under the CoM; the ZMP is where the load moves it.
    leant = np.array([FORCE[0] + MOMENT[1], FORCE[1] - MOMENT[0]]) / (1.15 * MASS * GRAVITY)
    for load, offset in ((NO_LOAD, np.zeros(2)), (LOAD, leant)):
        controller = robot.controller()
        terms = controller.observe(SimpleNamespace(q=robot.standing, v=np.zeros(robot.nv)))
        terms.bear(load)
        reference = references[0](zmp_offset=offset)
        qp = controller.build(terms, reference, controller.schedule.update(reference, FootSensing((490.0, 490.0))))
        answer = controller.interpret(terms, controller.solve(qp)[1])
        answers.append(answer.acceleration.copy())
        momentum = pin.computeCentroidalMap(robot.model, robot.model.createData(), robot.standing)
        changes = load.mass_scale * momentum @ answer.acceleration
        soles = terms.sole_wrench_map @ answer.wrench.ravel()
        weight = np.array([0.0, 0.0, load.mass_scale * MASS * GRAVITY])
        np.testing.assert_allclose(soles[:3] + load.force - weight, changes[:3], atol=1e-3)
        moment = soles[3:] - np.cross(terms.com, soles[:3]) + load.moment
        np.testing.assert_allclose(moment, changes[3:], atol=1e-3)
    np.testing.assert_allclose(*answers, atol=0.15)


def test_the_controller_estimates_only_what_it_is_given_wrenches_for(robot, references, loaded):
    reference, wrench = references[0](), np.zeros((2, 6))
    wrench[:, 2] = 0.6 * MASS * GRAVITY
    scales = []
    for sensing in (loaded, replace(loaded, wrench=wrench)):
        controller = robot.controller()
        for _ in range(60):
            controller.observe(SimpleNamespace(q=robot.standing, v=np.zeros(robot.nv)))
            report = controller.update(reference, sensing)
        scales.append(report.load.mass_scale)
    assert scales[0] == 1.0
    assert scales[1] == pytest.approx(1.2)
