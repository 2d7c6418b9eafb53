"""Metrics of a log whose motion is known, against their definitions."""

from types import SimpleNamespace

import numpy as np
import pytest
from mcap.reader import make_reader
from mcap.writer import Writer

from surefoot.scenarios.errors import LogError
from surefoot.scenarios.judge.digest import RunView
from surefoot.scenarios.judge.metrics import OWN, compute, digest
from surefoot.scenarios.log import LogWriter, read
from surefoot.scenarios.run.run import run_scenario

pytestmark = pytest.mark.unit

NAMES = (
    "fell fall_time fall_warning duration steps_planned place_error heading_error "
    "waypoints_missed steps_taken touchdowns_missed "
    "standing_time_final standing_time_between velocity_error yaw_rate_error zmp_inside_fraction "
    "zmp_excursion_max cop_ratio_p99 cop_ratio_max zmp_error_rms zmp_error_max com_error_rms dcm_error_rms "
    "capture_margin_min step_shift step_timing "
    "footstep_error_max stair_edge_margin_min swing_clearance_min foot_slip_max stance_twist_max stance_tilt_max "
    "contact_force_peak unplanned_flight_time self_contact_time "
    "torque_ratio_max knee_torque_rms torque_at_limit_fraction "
    "joint_limit_margin_min coupling_error joint_speed_ratio_max knee_angle_mean cost_of_transport speed_mean "
    "path_length displacement heading_change com_height_range estimation_error_rms planner_infeasible_fraction "
    "dcm_estimation_error_rms planner_time wbc_time controller_time deadlines_missed "
    "real_time_factor memory_growth qp_failures wbc_fallbacks log_bytes "
    "com_estimation_error_rms velocity_estimation_error_rms tilt_estimation_error_rms "
    "estimation_drift estimation_yaw estimation_yaw_rate estimation_nees contact_estimation_error ghost_force_max "
    "ghost_moment_max command_age commands_missed states_missed commands_limited shadow_difference"
)
"""Names of the public contract."""

WITHOUT_A_VALUE = (
    "knee_stance_mean knee_heel_strike knee_midstance landing_peak landing_rate heel_strike_pitch toe_off_pitch "
    "toe_clearance_min human_share human_correlation "
    "fall_time fall_warning place_error heading_error waypoints_missed velocity_error yaw_rate_error "
    "stair_edge_margin_min "
    "coupling_error memory_growth com_estimation_error_rms velocity_estimation_error_rms "
    "tilt_estimation_error_rms estimation_drift estimation_yaw estimation_yaw_rate estimation_nees "
    "contact_estimation_error command_age commands_missed states_missed commands_limited "
    "shadow_difference"
)
"""Metrics that the invented walk has nothing for."""


@pytest.fixture
def metrics(tmp_path, robot, two_steps):
    def make(motion):
        return run_scenario(two_steps, tmp_path, None, motion, robot).verdict.metrics

    return make


def test_all_names_of_the_contract_are_there(metrics, motion):
    found = metrics(motion())
    assert list(found) == list(OWN)
    assert not set(NAMES.split()) - set(found)
    without = {name for name, value in found.items() if value is None}
    assert without == set(WITHOUT_A_VALUE.split())
    assert all(OWN[name].fits(value) for name, value in found.items())


def test_errors_are_the_offsets_that_were_put_in(metrics, motion):
    found = metrics(motion(zmp_offset=(0.003, -0.004), plan_offset=(0.001, -0.002, 0.003)))
    assert found["zmp_error_rms"] == pytest.approx([0.003, 0.004])
    assert found["com_error_rms"] == pytest.approx([0.001, 0.002, 0.003])
    assert found["dcm_error_rms"] == pytest.approx([0.001, 0.002])
    assert found["estimation_error_rms"] == pytest.approx(0.001)
    assert found["dcm_estimation_error_rms"] == pytest.approx([0.001, 0.0])
    assert found["footstep_error_max"] == pytest.approx(0.006)


def test_walk(metrics, motion):
    found = metrics(motion(speed=0.4))
    assert found["steps_planned"] == found["steps_taken"] == 2
    assert found["fell"] is False
    assert found["duration"] == pytest.approx(4.0)
    assert found["speed_mean"] == pytest.approx(0.4)
    assert found["standing_time_final"] == pytest.approx(2.5)
    assert found["foot_slip_max"] == pytest.approx(0.2, abs=1e-3)
    assert found["knee_angle_mean"] == pytest.approx(0.4)
    assert found["com_height_range"] == 0.0


def test_way_and_heading(metrics, motion):
    """The feet's middle goes 0.2 m to either touchdown; the invented robot turns with its feet, starting aslant."""
    found = metrics(motion(speed=0.4))
    assert found["path_length"] == pytest.approx(0.4)
    assert found["displacement"] == pytest.approx([0.4, 0.0])
    assert found["heading_change"] == pytest.approx(0.0)
    found = metrics(motion(speed=0.4, yaw=(3.0, 4.0)))
    assert found["heading_change"] == pytest.approx(4.0 * (1.0 - 1 / 2000))
    assert found["displacement"] == pytest.approx([0.4 * np.cos(3.0), -0.4 * np.sin(3.0)])


def test_standing_between_steps(metrics, motion):
    """From 0.5 s to 1.5 s the invented robot walks; it pauses for the time given, from 1 s on."""
    assert metrics(motion())["standing_time_between"] == 0.0
    assert metrics(motion(pause=0.3))["standing_time_between"] == pytest.approx(0.3)


def test_knees_are_bent_from_where_they_are_straight(tmp_path, two_steps, motion, robot):
    knees = [robot.joint_names.index(name) for name in robot.roles.knees]
    straight = robot.straight_joint_positions.copy()
    straight[knees] = (0.15, -0.05)
    other = SimpleNamespace(**{**vars(robot), "straight_joint_positions": straight})
    found = run_scenario(two_steps, tmp_path, None, motion(speed=0.4), other).verdict.metrics
    assert found["knee_angle_mean"] == pytest.approx(0.4 - (0.15 + 0.05) / 2)


def test_effort(metrics, motion):
    found = metrics(motion())
    assert found["torque_ratio_max"] == pytest.approx(0.4)
    assert found["knee_torque_rms"] == pytest.approx(np.sqrt((40.0**2 + 0.0**2) / 2))
    assert found["joint_limit_margin_min"] == pytest.approx(0.1)
    work, way = 4 * 10.0 * 0.5 * 4.0, 0.4
    assert found["cost_of_transport"] == pytest.approx(work / (100.0 * 9.81 * way))
    assert found["real_time_factor"] == pytest.approx(4.0)
    assert found["planner_time"] == pytest.approx({"median": 200e-6, "p99": 200e-6})
    assert found["wbc_time"] == pytest.approx({"median": 140e-6, "p99": 140e-6})
    assert found["controller_time"] == pytest.approx({"median": 300e-6, "p99": 300e-6, "p999": 300e-6})
    assert found["deadlines_missed"] == 1
    assert found["qp_failures"] == found["wbc_fallbacks"] == 0


def test_centre_of_pressure_of_the_stance_foot(metrics, motion):
    found = metrics(motion())
    assert found["cop_ratio_p99"] == pytest.approx(0.4)
    assert found["cop_ratio_max"] == pytest.approx(0.4)


@pytest.mark.parametrize(
    ("offset", "inside"),
    [
        ((0.0, 0.0), 1.0),
        ((0.0337, -0.0337), 1.0),
        ((0.0338, 0.0), 0.0),
        ((0.0, 0.0338), 0.75),
        ((0.0, 0.125 + 0.0337), 0.75),
        ((0.0, 0.125 + 0.0338), 0.0),
        ((np.nan, np.nan), 0.0),
    ],
)
def test_zmp_inside_the_hull_of_the_feet_shrunk_to_90_percent(metrics, motion, offset, inside):
    """Soles of 0.075 m, 0.25 m apart: 0.03375 m is 90 % of half a sole; a quarter of the run is single support."""
    assert metrics(motion(zmp_offset=offset))["zmp_inside_fraction"] == pytest.approx(inside)


@pytest.mark.parametrize(
    ("offset", "excursion"), [((0.01, 0.0), -0.02375), ((0.04, 0.0), 0.00625), ((0.0, -0.05), 0.01625)]
)
def test_largest_error_and_excursion_of_the_zmp(metrics, motion, offset, excursion):
    found = metrics(motion(zmp_offset=offset))
    assert found["zmp_error_max"] == pytest.approx([abs(value) for value in offset])
    assert found["zmp_excursion_max"] == pytest.approx(excursion)


def test_flight_is_no_excursion(metrics, motion):
    found = metrics(motion(zmp_offset=(np.nan, np.nan)))
    assert found["zmp_excursion_max"] is None
    assert found["zmp_error_max"] is None


def test_a_fall_is_found_with_its_time(metrics, motion):
    found = metrics(motion(fall_at=1.2))
    assert found["fell"] is True
    assert found["fall_time"] == pytest.approx(1.2)
    assert found["steps_taken"] == 1


def test_a_run_cut_short_gives_what_it_can(metrics, motion):
    found = metrics(motion(stop_at=0.3))
    assert found["speed_mean"] is None
    assert found["cop_ratio_p99"] is None
    assert found["footstep_error_max"] is None
    assert found["steps_taken"] == 0
    assert found["duration"] == pytest.approx(0.3)


def test_nan_is_never_a_number_of_the_verdict(metrics, motion):
    found = metrics(motion(plan_offset=(np.nan, np.nan, np.nan)))
    assert found["com_error_rms"] is None


def test_an_empty_run_has_no_metrics_but_its_size(metrics, motion):
    found = metrics(motion(stop_at=0.0))
    assert {name for name, value in found.items() if value is not None} == {"steps_planned", "log_bytes"}


def cut_anywhere(source, target):
    """A log as other tools write it again: in order, in chunks of so many bytes."""
    with source.open("rb") as before, target.open("wb") as after:
        reader, writer, numbers = make_reader(before), Writer(after, chunk_size=200_000), {}
        writer.start()
        for record in reader.iter_metadata():
            writer.add_metadata(record.name, record.metadata)
        for file in reader.iter_attachments():
            writer.add_attachment(0, 0, file.name, file.media_type, file.data)
        for schema, channel, message in reader.iter_messages():
            if channel.id not in numbers:
                made = writer.register_schema(schema.name, schema.encoding, schema.data)
                numbers[channel.id] = writer.register_channel(channel.topic, "protobuf", made, channel.metadata)
            stamp = message.log_time
            writer.add_message(numbers[channel.id], stamp, message.data, stamp, message.sequence)
        writer.finish()
    return target


def test_windows_of_a_long_log_lose_no_tick_and_shift_none(tmp_path, robot, two_steps, motion):
    """Chunks of others end within a tick, some of its messages in the next; gathered is what the whole log has."""
    own = run_scenario(two_steps, tmp_path, None, motion(duration=9.0, zmp_offset=(0.003, 0.0)), robot).log
    log = read(cut_anywhere(own, tmp_path / "cut.mcap"))
    gathered, whole = digest(log), RunView(log)
    sizes = [[len(part[topic]) for topic in ("/measurement", "/truth", "/timing")] for part in log.windows(log.numeric)]
    assert len(sizes) > 2
    assert any(len(set(row)) > 1 for row in sizes)
    assert len(gathered.reduced)
    for reduction in gathered.reduced:
        np.testing.assert_array_equal(gathered.reduced[reduction], reduction(whole), reduction.function.__name__)


def test_a_log_of_something_else(tmp_path):
    with LogWriter(tmp_path / "log.mcap", {"run": {"seed": "{"}}):
        pass
    with pytest.raises(LogError, match="does not describe a run"):
        compute(read(tmp_path / "log.mcap"))


def test_margins_and_what_was_made_of_steps(metrics, motion):
    """The margin falls by 0.1 m/s from 0.3 m; each plan moves the next landing by 3 and 4 mm and makes it sooner."""
    found = metrics(motion())
    assert found["capture_margin_min"] == pytest.approx(0.3 - 0.1 * 3.98)
    assert found["step_shift"] == pytest.approx(0.005)
    assert found["step_timing"] == pytest.approx(0.02)
    assert found["fall_warning"] is None


def test_a_fall_is_known_before_it_comes(metrics, motion):
    found = metrics(motion(fall_at=1.2))
    assert found["fall_warning"] == pytest.approx(0.2, abs=0.021)
    assert found["fall_time"] == pytest.approx(1.2)


@pytest.mark.parametrize("how", [{"margins": "absent"}, {"margins": "untold"}])
def test_a_log_without_margins_tells_none(metrics, motion, how):
    """Such logs are of a version before margins, and of a planner of one's own, whose plans have none."""
    found = metrics(motion(**how))
    assert {found[name] for name in ("capture_margin_min", "step_shift", "step_timing")} == {None}
    assert found["dcm_error_rms"] is not None
