"""Values that the recorder derives from a tick, against the definitions, whatever the order of the columns."""

from types import SimpleNamespace

import numpy as np
import pytest

from surefoot.scenarios.log import LogWriter, read
from surefoot.scenarios.record.body import Recorder
from surefoot.scenarios.record.channels import Sizes
from surefoot.wbc.contact.zmp import centre_of_pressure, measured_zmp
from surefoot.wbc.types import ExternalLoad, SolveStatus

pytestmark = pytest.mark.unit

NJ = 4
LIMIT = np.array([100.0, 80.0, 50.0, 200.0])
STATUSES = (SolveStatus.SOLVED, SolveStatus.SECOND_SOLVER, SolveStatus.SOFTENED, SolveStatus.HELD)


def tick(rng, status):
    """All that the recorder is given in a tick, invented."""
    rotation = np.linalg.qr(rng.normal(size=(3, 3, 3)))[0]
    wrench = rng.normal(size=(2, 6)) * 20
    wrench[:, 2] = rng.uniform(100, 500, 2)
    measurement = SimpleNamespace(
        nonfoot_contact=0, self_contact=1, joint_position=rng.normal(size=NJ), joint_velocity=rng.normal(size=NJ),
        joint_torque=rng.normal(size=NJ), gyro=rng.normal(size=3), accelerometer=rng.normal(size=3), wrench=wrench,
        external_force=rng.normal(size=3), q=rng.normal(size=NJ + 7), v=rng.normal(size=NJ + 6),
    )  # fmt: skip
    position = rng.normal(size=(2, 3))
    truth = SimpleNamespace(
        com=rng.normal(size=3), com_velocity=rng.normal(size=3), angular_momentum=rng.normal(size=3),
        sole_pose=np.column_stack((position, np.zeros((2, 3)), np.ones(2))), sole_position=position,
        sole_rotation=rotation[:2], torso_rotation=rotation[2],
    )  # fmt: skip
    report = SimpleNamespace(
        active=(True, False), edge=(0, 1), felt=(False, True), status=status, iterations=7, primal_residual=1e-9,
        dual_residual=2e-9, acceleration=rng.normal(size=NJ + 6), wrench=rng.normal(size=(2, 6)),
        task_error=rng.normal(size=18),
        load=ExternalLoad(rng.normal(size=3), rng.normal(size=3), rng.uniform(0.8, 1.2)),
    )  # fmt: skip
    terms = SimpleNamespace(
        com=rng.normal(size=3), com_velocity=rng.normal(size=3), model_mass=100.0,
        q=rng.normal(size=NJ + 7), v=rng.normal(size=NJ + 6),
    )  # fmt: skip
    planned = SimpleNamespace(contacts=(True, True), omega=rng.uniform(2, 4))
    return measurement, truth, terms, planned, report, rng.normal(size=NJ) * 30


def test_derived_fields_follow_their_definitions(tmp_path):
    rng = np.random.default_rng(5)
    ticks = [tick(rng, status) for status in STATUSES]
    with LogWriter(tmp_path / "log.mcap", {}) as writer:
        recorder = Recorder(writer, Sizes(nj=NJ, nq=NJ + 7, nv=NJ + 6, horizon=50), LIMIT)
        for number, given in enumerate(ticks):
            recorder.tick(number * 2_000_000, *given)
    log = read(tmp_path / "log.mcap")

    assert log["/wbc"].field("status").tolist() == [int(status) for status in STATUSES]
    assert log["/wbc"].field("solver").tolist() == [0, 1, 0, 0]
    assert log["/wbc"].field("fallback").tolist() == [0, 0, 1, 1]
    assert log["/contact"].field("felt").tolist() == [[0, 1]] * len(STATUSES)
    for n, (*_, report, _) in enumerate(ticks):
        estimate = log["/estimate"]
        assert estimate.field("mass")[n] == pytest.approx(100.0 * report.load.mass_scale)
        np.testing.assert_array_equal(estimate.field("external_force")[n], report.load.force)
        np.testing.assert_array_equal(estimate.field("external_moment")[n], report.load.moment)
    for n, (measurement, truth, terms, planned, _, torque) in enumerate(ticks):
        zmp = measured_zmp(measurement.wrench, truth.sole_position, truth.sole_rotation)
        row = {name: log[topic].field(name)[n] for topic, name in (
            ("/estimate", "dcm"), ("/truth", "torso_tilt"), ("/torque", "limit_ratio_max"), ("/contact", "zmp"),
            ("/contact", "normal_force"), ("/contact", "cop_left"), ("/contact", "cop_right"),
        )}  # fmt: skip
        assert row["dcm"] == pytest.approx(terms.com[:2] + terms.com_velocity[:2] / planned.omega)
        assert np.cos(row["torso_tilt"]) == pytest.approx(truth.torso_rotation[2, 2])
        assert row["limit_ratio_max"] == pytest.approx(np.max(np.abs(torque) / LIMIT))
        assert row["zmp"] == pytest.approx(zmp)
        assert row["normal_force"] == pytest.approx(measurement.wrench[:, 2])
        for foot, side in enumerate(("left", "right")):
            assert row[f"cop_{side}"] == pytest.approx(centre_of_pressure(measurement.wrench[foot]))


def logged(tmp_path, change):
    """Values derived of a tick that is changed before it is recorded, by topic and field."""
    given = tick(np.random.default_rng(6), SolveStatus.SOLVED)
    change(*given)
    with LogWriter(tmp_path / "log.mcap", {}) as writer:
        Recorder(writer, Sizes(nj=NJ, nq=NJ + 7, nv=NJ + 6, horizon=50), LIMIT).tick(0, *given)
    log = read(tmp_path / "log.mcap")
    fields = {"/contact": ("zmp", "cop_left", "cop_right"), "/torque": ("limit_ratio_max",), "/truth": ("torso_tilt",)}
    fields["/estimate"] = ("base_position", "base_velocity")
    return given, {name: log[topic].field(name)[0] for topic, names in fields.items() for name in names}


@pytest.mark.parametrize("foot", [0, 1])
def test_a_foot_without_load_has_no_centre_of_pressure_and_the_zmp_is_of_the_other(tmp_path, foot):
    def lift(measurement, *_):
        measurement.wrench[foot] = 0.0

    (measurement, truth, *_), row = logged(tmp_path, lift)
    sides = ("left", "right")
    assert np.isnan(row[f"cop_{sides[foot]}"]).all()
    assert np.isfinite(row[f"cop_{sides[1 - foot]}"]).all()
    assert row["zmp"] == pytest.approx(measured_zmp(measurement.wrench, truth.sole_position, truth.sole_rotation))


def test_in_flight_there_is_no_zmp(tmp_path):
    def fly(measurement, *_):
        measurement.wrench[:] = 0.0

    row = logged(tmp_path, fly)[1]
    assert np.isnan(row["zmp"]).all()


@pytest.mark.parametrize("joint", range(NJ))
def test_a_torque_that_is_no_number_has_no_ratio(tmp_path, joint):
    def spoil(*given):
        given[-1][joint] = np.nan

    assert np.isnan(logged(tmp_path, spoil)[1]["limit_ratio_max"])


@pytest.mark.parametrize(("upright", "tilt"), [(1.0 + 1e-15, 0.0), (-1.0 - 1e-15, np.pi)])
def test_a_rotation_that_is_rounded_has_a_tilt(tmp_path, upright, tilt):
    def turn(measurement, truth, *_):
        truth.torso_rotation[2, 2] = upright

    assert logged(tmp_path, turn)[1]["torso_tilt"] == tilt


def test_the_base_is_that_of_the_state_that_the_controller_was_given(tmp_path):
    (_, _, terms, *_), row = logged(tmp_path, lambda *_: None)
    np.testing.assert_array_equal(row["base_position"], terms.q[:3])
    np.testing.assert_array_equal(row["base_velocity"], terms.v[:6])
