"""Laws of the invariant filter: its error dynamics, what it cannot observe, and whether it knows how wrong it is."""

from copy import deepcopy
from dataclasses import replace

import numpy as np
import pinocchio as pin
import pytest

from surefoot.wbc.estimation.covariance import UNSURE, Covariance
from surefoot.wbc.estimation.invariant_filter import InvariantFilter
from surefoot.wbc.estimation.parameters import GroundNoise, SensorNoise
from surefoot.wbc.estimation.stand import AXES, FOOT, FORCE, GYRO, OFFSETS, POSITION, SOLE, TURN, VELOCITY, Stand

pytestmark = pytest.mark.unit

PERIOD, JOINTS = 0.002, 4
OFFS = JOINTS + AXES
COUNT = OFFSETS.start + OFFS
NOISE = SensorNoise(accelerometer_density=5e-3, encoder=1e-4, encoder_offset=1e-3)
GROUND = GroundNoise(creep=5e-4, sinking=5e-4, rocking=5e-4, model=0.0, light=1.0, landing=5e-4, landing_turn=5e-4)


def somewhere(rng):
    """A state of the filter far from the origin."""
    rotations = [pin.exp3(rng.normal(size=3)) for _ in range(3)]
    return Stand(
        rotations[0], rng.normal(scale=3.0, size=(4, 3)), np.stack(rotations[1:]), *rng.normal(size=(2, 3)),
        rng.normal(size=OFFS),
    )  # fmt: skip


def error(true, believed):
    """The error of the right, in the order of the filter."""
    E = true.R @ believed.R.T
    columns = true.columns - believed.columns @ E.T
    turns = [pin.log3(true.Z[k] @ believed.Z[k].T) for k in (0, 1)]
    rest = true.gyro_bias - believed.gyro_bias, true.force_bias - believed.force_bias, true.offsets - believed.offsets
    return np.concatenate((pin.log3(E), columns.ravel(), *turns, *rest))


def propagated(stand, rate, force):
    """The state after a period."""
    filter_ = InvariantFilter(deepcopy(stand), NOISE, GROUND)
    filter_.propagate(rate, force, PERIOD)
    return filter_.stand


def test_the_state_goes_on_by_what_the_imu_says_less_its_biases():
    """As a body that falls and is pushed evenly, with the push as seen from half way through its turn."""
    rng, time = np.random.default_rng(9), 0.3
    before, rate, force = somewhere(rng), rng.normal(size=3), 10.0 * rng.normal(size=3)
    filter_ = InvariantFilter(deepcopy(before), NOISE, GROUND)
    filter_.propagate(rate, force, time)
    turn, found = time * (rate - before.gyro_bias), filter_.stand
    push = before.R @ pin.exp3(0.5 * turn) @ (force - before.force_bias) + [0.0, 0.0, -9.81]
    np.testing.assert_allclose(found.R, before.R @ pin.exp3(turn), atol=1e-14)
    np.testing.assert_allclose(found.v, before.v + time * push, atol=1e-14)
    np.testing.assert_allclose(found.p, before.p + time * before.v + 0.5 * time**2 * push, atol=1e-14)
    np.testing.assert_allclose(filter_.acceleration, push, atol=1e-14)
    np.testing.assert_array_equal(found.d, before.d)
    np.testing.assert_array_equal(found.Z, before.Z)


def transition(stand):
    """The transition of an error over a period."""
    F = np.eye(COUNT)
    Covariance(stand, NOISE, GROUND, False).advance(PERIOD, F)
    return F


@pytest.mark.parametrize("seed", range(4))
def test_errors_go_on_as_the_transition_says_whatever_the_state(seed):
    """Group-affine: but for the columns of the biases the transition of a small error knows no state."""
    rng = np.random.default_rng(seed)
    stand, rate, force = somewhere(rng), rng.normal(size=3), 10.0 * rng.normal(size=3)
    F, other = transition(stand), transition(somewhere(rng))
    np.testing.assert_array_equal(F[:, :21], other[:, :21])
    assert np.abs(F[:, GYRO] - other[:, GYRO]).max() > 1e-4
    before = propagated(stand, rate, force)
    for column in range(COUNT):
        x = np.zeros(COUNT)
        x[column] = 1e-6
        moved = deepcopy(stand)
        moved.move(x)
        after = error(propagated(moved, rate, force), before) / 1e-6
        # Within a period the rotation turns by what the biases' columns leave out.
        within = 2.0 * PERIOD**2 * (np.linalg.norm(force) + 10.0) + 1e-4 * PERIOD * np.abs(stand.columns).max()
        np.testing.assert_allclose(after, F[:, column], atol=within + 2e-5)


def test_no_reading_tells_the_heading_or_the_place():
    """Additions to the covariance along these are there afterwards, which a tilt that is added is not."""
    rng = np.random.default_rng(3)
    J = rng.normal(size=(2, 6, OFFS))

    def weighed(direction):
        filter_ = InvariantFilter(somewhere(np.random.default_rng(3)), NOISE, GROUND)
        base = np.diag(np.full(COUNT, 1e-6))
        filter_.P[:] = base + np.outer(direction, direction)
        filter_.weigh(J)
        return filter_.P, filter_.covariance.gain

    everything = np.zeros(COUNT)
    without, gain = weighed(everything)
    for axis in range(4):
        direction = everything.copy()
        if axis < 3:
            for where in (POSITION, *FOOT):
                direction[where.start + axis] = 0.1
        else:
            for where in (TURN, *SOLE):
                direction[where.stop - 1] = 0.1
        found, changed = weighed(direction)
        np.testing.assert_allclose(found, without + np.outer(direction, direction), atol=1e-9)
        np.testing.assert_allclose(changed, gain, atol=1e-6)
    tilted = everything.copy()
    tilted[TURN.start] = 0.1
    found, _ = weighed(tilted)
    assert found[0, 0] < 0.1 * 0.1**2


def test_a_foot_that_lands_is_as_unsure_as_the_joints_that_say_where_it_is():
    """Zeros of the joints that are off by o move a sole by -J o in the frame of the IMU, which the attitude turns."""
    rng = np.random.default_rng(6)
    filter_, J, unsure = InvariantFilter(somewhere(rng), NOISE, GROUND), rng.normal(size=(6, OFFS)), 1e-3
    filter_.P[:] = 0.0
    filter_.P[OFFSETS, OFFSETS] = unsure**2 * np.eye(OFFS)
    filter_.land(1, rng.normal(size=3), pin.exp3(rng.normal(size=3)), J, None, 0.0, 0.0)
    moved = np.concatenate((-filter_.stand.R @ J[:3], -filter_.stand.R @ J[3:]))
    places = [*range(COUNT)[FOOT[1]], *range(COUNT)[SOLE[1]]]
    np.testing.assert_allclose(filter_.P[places][:, OFFSETS], unsure**2 * moved, atol=1e-15)
    np.testing.assert_allclose(filter_.P[np.ix_(places, places)], unsure**2 * moved @ moved.T, atol=1e-15)


def squares(sensors, seeds=8, duration=2.0):
    """Mean square of errors over deviations of velocity, tilt and place from the stance foot, of synthetic steps."""
    found = []
    for seed in range(seeds):
        rng = np.random.default_rng(seed)
        found.append(_walked(rng, sensors, duration))
    return np.mean(found, axis=0)


def _walked(rng, sensors, duration):
    root = 1.0 / np.sqrt(PERIOD)
    bias, pull = NOISE.gyro_bias * rng.normal(size=3), NOISE.accelerometer_bias * rng.normal(size=3)
    offsets = np.r_[NOISE.encoder_offset * rng.normal(size=JOINTS), NOISE.mounting * rng.normal(size=AXES)]
    R, p, v = np.eye(3), np.array([0.0, 0.0, 1.0]), np.zeros(3)
    feet, soles = np.array([[0.0, 0.1, 0.0], [0.0, -0.1, 0.0]]), np.stack((np.eye(3), np.eye(3)))
    shape = rng.normal(size=(3, 2, 6, JOINTS))
    # At first the feet are told by offsets that the filter does not know of.
    stand = Stand(R, np.vstack((v, p, feet)), soles, np.zeros(3), np.zeros(3), np.zeros(OFFS))
    filter_ = InvariantFilter(deepcopy(stand), sensors, GROUND)

    def seen(time):
        way = 0.3 * (shape[0] + np.sin(2.0 * time) * shape[1] + np.cos(3.0 * time) * shape[2])
        y = np.array([R.T @ (feet[k] - p) for k in (0, 1)])
        J = np.concatenate((way, np.stack([np.vstack((-pin.skew(at), np.eye(3))) for at in y])), axis=2)
        off = offsets - filter_.stand.offsets + np.r_[NOISE.encoder * rng.normal(size=JOINTS), np.zeros(AXES)]
        y += np.array([J[k, :3] @ off for k in (0, 1)])
        Y = np.array([pin.exp3(J[k, 3:] @ off) @ R.T @ soles[k] for k in (0, 1)])
        return y, Y, J

    y, Y, J = seen(0.0)
    normals = np.tile([0.0, 0.0, 1.0], (2, 1))
    filter_.begin(y, Y, J, normals, 0.1)
    found, standing = [], [True, True]
    for tick in range(1, round(duration / PERIOD)):
        time = tick * PERIOD
        rate = 0.3 * np.array([np.sin(3.0 * time), np.cos(2.0 * time), np.sin(time)])
        acceleration = np.array([np.sin(2.0 * time), np.cos(3.0 * time), 0.5 * np.sin(5.0 * time)])
        half = pin.exp3(0.5 * PERIOD * rate)
        force = (R @ half).T @ (acceleration + np.array([0.0, 0.0, 9.81]))
        p, v, R = p + PERIOD * v + 0.5 * PERIOD**2 * acceleration, v + PERIOD * acceleration, R @ half @ half
        filter_.propagate(
            rate + bias + NOISE.gyro_density * root * rng.normal(size=3),
            force + pull + NOISE.accelerometer_density * root * rng.normal(size=3),
            PERIOD,
        )
        for k in (0, 1):
            if standing[k]:
                feet[k] += GROUND.creep * np.sqrt(PERIOD) * rng.normal(size=3)
                soles[k] = pin.exp3(GROUND.rocking * np.sqrt(PERIOD) * rng.normal(size=3)) @ soles[k]
        y, Y, J = seen(time)
        swing = (tick // 150) % 2 if tick % 150 < 110 else -1
        changed = [k != swing for k in (0, 1)] != standing
        if changed or tick % 5 == 0:
            filter_.spread((0.5, 0.5))
            for k in (0, 1):
                if k == swing and standing[k]:
                    filter_.lift(k)
                    feet[k] += [0.1, 0.0, 0.0]
                if k != swing and not standing[k]:
                    y, Y, J = seen(time)
                    place, turn = GROUND.landing, GROUND.landing_turn
                    filter_.land(k, y[k], Y[k], J[k], None, place, turn)
                    feet[k] += place * rng.normal(size=3)
                    soles[k] = pin.exp3(turn * rng.normal(size=3)) @ soles[k]
            standing = [k != swing for k in (0, 1)]
            y, Y, J = seen(time)
            filter_.weigh(J)
        filter_.correct(y, Y)
        if tick % 100 == 0 and time > 0.5:
            s = filter_.stand
            E = R @ s.R.T
            x = np.concatenate((pin.log3(E)[:2], v - E @ s.v))
            P = filter_.P[np.ix_([0, 1, 3, 4, 5], [0, 1, 3, 4, 5])]
            found.append((x @ np.linalg.solve(P, x) / 5.0, x[2:] @ np.linalg.solve(P[2:, 2:], x[2:]) / 3.0))
    return np.mean(found, axis=0)


def test_errors_are_as_large_as_the_filter_says():
    """From both sides; a filter that is told too little is far too sure, one that is told too much not sure enough."""
    both = squares(NOISE)
    assert (both > 0.5).all() and (both < 2.0).all(), both
    little = replace(NOISE, accelerometer_density=2e-4, encoder=1e-5, encoder_offset=1e-5, mounting=1e-5)
    sure = squares(little, seeds=2)
    assert (sure > 4.0).all(), sure
    timid = squares(replace(NOISE, accelerometer_density=5e-2, encoder=1e-3), seeds=2)
    assert timid[1] < 0.3, timid


def test_after_the_start_soles_are_where_the_zeros_that_it_has_found_say():
    """Level soles tell of the zeros; soles left where they were seen by the old ones would have slipped at once."""
    rng = np.random.default_rng(5)
    feet = np.array([[0.0, 0.1, -1.0], [0.0, -0.1, -1.0]])
    stand = Stand(
        np.eye(3), np.vstack((np.zeros((2, 3)), feet)), np.stack((np.eye(3),) * 2), *np.zeros((2, 3)), np.zeros(OFFS)
    )
    filter_, J = InvariantFilter(stand, NOISE, GROUND), rng.normal(size=(2, 6, OFFS))
    Y = np.stack([pin.exp3(2e-3 * rng.normal(size=3)) for _ in range(2)])
    filter_.begin(feet, Y, J, np.tile([0.0, 0.0, 1.0], (2, 1)), 0.1)
    assert np.abs(stand.offsets).max() > 1e-4
    filter_.weigh(J)
    y = feet - J[:, :3] @ stand.offsets
    seen = np.stack([pin.exp3(-J[k, 3:] @ stand.offsets) @ Y[k] for k in (0, 1)])
    filter_.correct(y, seen)
    np.testing.assert_allclose(filter_.residual, 0.0, atol=1e-12)


def test_heading_and_place_of_the_world_are_those_of_the_soles():
    """A turn of the mount that is found later turns the IMU by as much, and neither the soles nor the way they go."""
    feet, mounting = np.array([[0.3, 0.1, -1.0], [0.1, -0.1, -1.0]]), 5e-3
    stand = Stand(
        np.eye(3), np.vstack((np.zeros((2, 3)), feet)), np.stack((np.eye(3),) * 2), *np.zeros((2, 3)), np.zeros(AXES)
    )
    filter_ = InvariantFilter(stand, replace(NOISE, mounting=mounting), GROUND)
    J = np.stack([np.vstack((-pin.skew(at), np.eye(3))) for at in feet])
    filter_.begin(feet, np.stack((np.eye(3),) * 2), J, np.tile([0.0, 0.0, 1.0], (2, 1)), 0.1)
    P, heading = filter_.P, TURN.stop - 1
    assert np.sqrt(P[-1, -1]) == pytest.approx(mounting, rel=1e-2)
    assert P[heading, -1] / P[-1, -1] == pytest.approx(1.0, abs=1e-2)
    # The error of a place is that of the group: ξ_d + ξ_R x d.
    soles = np.stack([filter_.P[SOLE[k], :][2] for k in (0, 1)])
    assert np.sqrt(np.mean(soles[:, [SOLE[k].stop - 1 for k in (0, 1)]])) < 2.0 * GROUND.turning
    middle = np.zeros((2, len(P)))
    for k in (0, 1):
        middle[:, FOOT[k]] += 0.5 * np.eye(3)[:2]
        middle[:, TURN] -= 0.5 * pin.skew(feet[k])[:2]
    assert np.sqrt(np.diag(middle @ P @ middle.T)).max() < 2.0 * GROUND.kinematics


def test_encoder_zeros_are_found_as_far_as_steps_tell_them():
    """Their deviation shrinks, and the offsets come nearer."""
    rng = np.random.default_rng(2)
    filter_ = InvariantFilter(somewhere(rng), NOISE, GROUND)
    before = np.diag(filter_.P)[OFFSETS].copy()
    J = rng.normal(size=(2, 6, OFFS))
    for k in (0, 1):
        filter_.land(k, rng.normal(size=3), np.eye(3), J[k], None, 1e-4, 1e-4)
    filter_.weigh(rng.normal(size=(2, 6, OFFS)))
    assert (np.diag(filter_.P)[OFFSETS] < 0.5 * before).all()


@pytest.mark.parametrize("alone", [False, True])
@pytest.mark.parametrize("foot", [0, 1])
def test_a_foot_that_slipped_is_named(foot, alone):
    """A foot that is 2 cm away from where it stood is told from one that is not; noise alone is none."""
    rng = np.random.default_rng(4)
    filter_ = InvariantFilter(somewhere(rng), NOISE, GROUND)
    s, J = filter_.stand, 0.1 * rng.normal(size=(2, 6, OFFS))
    y = np.array([s.R.T @ (s.d[k] - s.p) for k in (0, 1)])
    Y = np.array([s.R.T @ s.Z[k] for k in (0, 1)])
    for k in (0, 1):
        filter_.land(k, y[k], Y[k], J[k], None, 1e-4, 1e-4)
    if alone:
        filter_.lift(1 - foot)
    filter_.weigh(J)
    assert filter_.correct(y + 1e-5 * rng.normal(size=(2, 3)), Y) == ()
    before = s.columns.copy()
    y[foot, 0] += 0.02
    assert filter_.correct(y, Y) == (foot,)
    np.testing.assert_array_equal(s.columns, before)
    assert filter_.correct(y, Y, (np.inf, np.inf)) == ()


def test_a_height_that_is_known_moves_the_robot_there():
    rng = np.random.default_rng(6)
    filter_ = InvariantFilter(somewhere(rng), NOISE, GROUND)
    filter_.P[POSITION, POSITION] += 1e-4 * np.eye(3)
    y = np.array([0.1, 0.2, -0.9])
    s = filter_.stand
    height = float((s.p + s.R @ y)[2]) - 0.01
    filter_.land(0, y, np.eye(3), np.zeros((6, OFFS)), (height, 1e-4), 1e-5, 1e-5)
    assert filter_.stand.d[0, 2] == pytest.approx(height, abs=2e-4)
    assert filter_.P[VELOCITY, VELOCITY].max() > 0.0 and filter_.P[FORCE, FORCE].max() > 0.0


@pytest.mark.parametrize("step", [0.02, -0.02, 0.1])
def test_a_landing_that_is_not_on_the_ground_that_is_believed_moves_nothing(step):
    """It is a step of the ground: the state is the one without a height, and what is believed counts again later."""
    unknown, off, on = (InvariantFilter(somewhere(np.random.default_rng(6)), NOISE, GROUND) for _ in range(3))
    y, J = np.array([0.1, 0.2, -0.9]), np.zeros((6, OFFS))
    height = float((on.stand.p + on.stand.R @ y)[2])
    for landed, known in ((unknown, None), (off, (height + step, 1.5e-3)), (on, (height + 0.05 * step, 1.5e-3))):
        landed.land(0, y, np.eye(3), J, known, 1e-3, 1e-3)
    np.testing.assert_array_equal(off.stand.columns, unknown.stand.columns)
    np.testing.assert_array_equal(off.P, unknown.P)
    assert np.abs(on.stand.columns - unknown.stand.columns).max() > 1e-4 * abs(step)
    assert on.P[FOOT[0], FOOT[0]][2, 2] < unknown.P[FOOT[0], FOOT[0]][2, 2]
    # The same step is none where the height is as unsure as it is high.
    off.P[POSITION, POSITION] += step**2 * np.eye(3)
    before = off.stand.columns.copy()
    off.land(0, y, np.eye(3), J, (height + step, 1.5e-3), 1e-3, 1e-3)
    assert np.abs(off.stand.columns - before).max() > 0.2 * abs(step)


def test_a_standing_sole_goes_where_the_springs_let_it_and_is_unsure_by_a_share_of_that():
    filter_, other = (InvariantFilter(somewhere(np.random.default_rng(7)), NOISE, GROUND) for _ in range(2))
    filter_.lift(1), other.lift(1)
    before, way = deepcopy(filter_.stand), np.array([[2e-3, -1e-3, 3e-4], [1.0, 1.0, 1.0]])
    for each, sprung in ((filter_, way), (other, None)):
        each.propagate(np.zeros(3), np.zeros(3), PERIOD)
        each.spread((1.0, 0.0), sprung)
    # In its own axes it has turned, the other, which does not stand, has not.
    np.testing.assert_allclose(pin.log3(before.Z[0].T @ filter_.stand.Z[0]), [2e-3, -1e-3, 0.0], atol=1e-12)
    np.testing.assert_array_equal(filter_.stand.Z[1], before.Z[1])
    np.testing.assert_allclose(filter_.stand.d - before.d, [[0.0, 0.0, 3e-4], [0.0, 0.0, 0.0]], atol=1e-15)
    more = np.diagonal(filter_.P - other.P)
    np.testing.assert_allclose(more[SOLE[0]], (UNSURE * before.Z[0] @ [2e-3, -1e-3, 0.0]) ** 2, atol=1e-12)
    np.testing.assert_allclose(more[FOOT[0]], [0.0, 0.0, (UNSURE * 3e-4) ** 2], atol=1e-15)
    assert np.abs(more[SOLE[1]]).max() == 0.0


def test_a_sole_on_its_edge_sinks_twice_as_much():
    found = []
    for leaning in (True, False):
        filter_ = InvariantFilter(somewhere(np.random.default_rng(8)), NOISE, GROUND, leaning)
        filter_.P[:] = 0.0
        filter_.propagate(np.zeros(3), np.zeros(3), PERIOD)
        filter_.spread((1.0, 1.0))
        found.append(np.diagonal(filter_.P)[FOOT[0]] - NOISE.gyro_density**2 * PERIOD * _beside(filter_.stand.d[0]))
    np.testing.assert_allclose(found[1], np.full(3, GROUND.sinking**2 * PERIOD), rtol=1e-9)
    np.testing.assert_allclose(found[0], found[1] * [1.0, 1.0, 4.0], rtol=1e-9)


def _beside(place):
    """Squares of how far a place is from each axis."""
    return place @ place - place**2


@pytest.mark.parametrize("leaning", [True, False])
def test_a_sole_that_leans_tells_how_it_is_turned_but_for_about_its_line(leaning):
    """One foot stands; a turn of its sole about an axis moves the attitude, unless it turns about that at will."""

    def turned(axis):
        stand = Stand(np.eye(3), np.zeros((4, 3)), np.stack((np.eye(3),) * 2), *np.zeros((2, 3)), np.zeros(OFFS))
        filter_ = InvariantFilter(stand, NOISE, GROUND, leaning)
        filter_.lift(1)
        filter_.P[TURN, TURN] += 1e-4 * np.eye(3)
        for _ in range(5):
            filter_.propagate(np.zeros(3), np.array([0.0, 0.0, 9.81]), PERIOD)
        filter_.spread((1.0, 0.0))
        filter_.weigh(np.zeros((2, 6, OFFS)))
        filter_.correct(np.zeros((2, 3)), np.stack((pin.exp3(1e-3 * axis),) * 2))
        return pin.log3(filter_.stand.R)

    across, along = turned(np.array([0.0, 1.0, 0.0])), turned(np.array([1.0, 0.0, 0.0]))
    assert across[1] < -5e-4
    assert abs(along[0]) < 2e-5 if leaning else along[0] < -5e-4


@pytest.mark.parametrize("rolls", [True, False])
def test_a_sole_that_rolls_tells_how_it_is_turned_but_for_about_its_edge(rolls):
    def turned(axis):
        stand = Stand(np.eye(3), np.zeros((4, 3)), np.stack((np.eye(3),) * 2), *np.zeros((2, 3)), np.zeros(OFFS))
        filter_ = InvariantFilter(stand, NOISE, GROUND)
        filter_.lift(1)
        filter_.P[TURN, TURN] += 1e-4 * np.eye(3)
        for _ in range(5):
            filter_.propagate(np.zeros(3), np.array([0.0, 0.0, 9.81]), PERIOD)
        filter_.spread((1.0, 0.0), None, (rolls, False))
        filter_.weigh(np.zeros((2, 6, OFFS)))
        filter_.correct(np.zeros((2, 3)), np.stack((pin.exp3(1e-3 * axis),) * 2))
        return pin.log3(filter_.stand.R)

    across, along = turned(np.array([0.0, 1.0, 0.0])), turned(np.array([1.0, 0.0, 0.0]))
    assert along[0] < -5e-4
    assert abs(across[1]) < 2e-5 if rolls else across[1] < -5e-4


def test_a_foot_that_is_seen_by_another_point_has_the_error_of_that_point():
    """The covariance follows the linear map of small errors."""
    rng, ahead, step = np.random.default_rng(11), 0.11, 1e-6
    believed = somewhere(rng)
    T = np.empty((COUNT, COUNT))
    for column in range(COUNT):
        true, x = deepcopy(believed), np.zeros(COUNT)
        x[column] = step
        true.move(x)
        filters = [InvariantFilter(deepcopy(each), NOISE, GROUND) for each in (true, believed)]
        for each in filters:
            each.shift(1, ahead)
        T[:, column] = error(filters[0].stand, filters[1].stand) / step
    filter_, root = InvariantFilter(deepcopy(believed), NOISE, GROUND), rng.normal(size=(COUNT, COUNT))
    filter_.P[:] = root @ root.T
    filter_.shift(1, ahead)
    np.testing.assert_allclose(filter_.P, T @ root @ root.T @ T.T, atol=1e-3 * COUNT)
    np.testing.assert_allclose(filter_.stand.d[1] - believed.d[1], ahead * believed.Z[1][:, 0], atol=1e-15)
    np.testing.assert_array_equal(filter_.stand.d[0], believed.d[0])
    assert np.abs(T - np.eye(COUNT)).max() > 0.5 * ahead
    filter_.shift(1, -ahead)
    np.testing.assert_allclose(filter_.P, root @ root.T, atol=1e-9 * COUNT)


def test_soles_that_lean_tell_the_attitude_at_the_start_by_the_heights_of_both():
    """However they are turned about their lines, which those that do not lean take for a tilt of the robot."""
    found = []
    for leaning in (True, False):
        soles = np.stack([pin.exp3(np.array([angle, 0.0, 0.0])) for angle in (-0.2, 0.1)])
        feet = np.array([[0.0, 0.1, 0.0], [0.0, -0.1, 0.0]])
        tilt = pin.exp3(np.array([0.02, 0.01, 0.0]))
        stand = Stand(
            tilt, np.vstack((np.zeros(3), [0.0, 0.0, 1.0], feet)), soles.copy(), *np.zeros((2, 3)), np.zeros(OFFS)
        )
        filter_ = InvariantFilter(stand, NOISE, GROUND, leaning)
        y = feet - [0.0, 0.0, 1.0]
        filter_.begin(y, soles, np.zeros((2, 6, OFFS)), np.tile([0.0, 0.0, 1.0], (2, 1)), 0.1)
        found.append(float(np.abs(pin.log3(filter_.stand.R)[:2]).max()))
    assert found[0] < 2e-3 < 0.02 < found[1]
