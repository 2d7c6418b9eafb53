"""Figures of logs: what they are drawn from is right, and whatever is missing is said."""

import json
import time
import warnings

import numpy as np
import pytest
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.text import Text
from scipy.spatial.transform import Rotation

from surefoot.scenarios.errors import LogError
from surefoot.scenarios.log import ChannelSpec, FieldSpec, LogWriter, read
from surefoot.scenarios.run.run import run_scenario
from surefoot.scenarios.setup.load import load as load_scenario
from surefoot.scenarios.show.figures.effort import angles, groups, speeds, stretch_extremes
from surefoot.scenarios.show.figures.ground import (
    friction_used,
    is_wide,
    landing_errors,
    loaded_wrench,
    yaw_moment_used,
)
from surefoot.scenarios.show.figures.motion import strips, support_bounds, true_dcm
from surefoot.scenarios.show.figures.page import FIGURES, page, plot, single
from surefoot.scenarios.show.kit.shading import background, stretches
from surefoot.scenarios.show.logview import LogView, MissingError
from surefoot.wbc.contact.cone import wrench_cone

pytestmark = pytest.mark.unit

SHORT = ("fidelity=pendulum", "gait.steps=2", "gait.single_support=0.6", "gait.initial_stand=0.2", "rates.control=100")


@pytest.fixture(scope="module")
def pendulum(tmp_path_factory):
    scenario = load_scenario("diagonal-walk", (*SHORT, "pushes=[{time: 1, duration: 0.1, force: [5, 0, 0]}]"))
    return run_scenario(scenario, tmp_path_factory.mktemp("pendulum")).log


@pytest.fixture
def body(tmp_path, robot, motion, two_steps):
    return run_scenario(two_steps, tmp_path, None, motion(duration=2.0), robot).log


def invented(path, source, fields):
    """A view of a log of values by topic and field, one row each second, with the records of another log."""
    with LogWriter(path, dict(read(source).metadata)) as writer:
        for topic, columns in fields.items():
            specs = tuple(FieldSpec(name, values.shape[1:]) for name, values in columns.items())
            channel = writer.channel(ChannelSpec(topic, topic.strip("/").title(), specs))
            for second, row in enumerate(zip(*columns.values(), strict=True)):
                channel.append(second * 10**9, *row)
    return LogView(read(path))


def texts(figure: Figure) -> list[str]:
    return [text.get_text() for text in figure.findobj(Text)]


def test_the_page_has_every_figure_with_units_on_its_axes(body):
    figure = page(LogView(read(body)), "header")
    labels = [axes.get_ylabel() for axes in figure.findobj(Axes)]
    assert len(labels) == 5 + 1 + 2 + 2 + 3 + 2 + 3 + 6 + 3
    assert [label for label in labels if "[" not in label] == 2 * [""]
    assert {"x [m]", "friction [%]", "beyond the plan [mm]"} <= set(labels)  # no feet are planned in this log
    words = texts(figure)
    absent = {word.removeprefix("not in this log: ") for word in words if word.startswith("not in this log")}
    assert absent <= {"such joints", "/footstep in this window", "/footstep", "velocity_limit of the run"}
    assert "single support (L, R: the stance foot)" in words
    assert "time [s]" in words


@pytest.mark.parametrize(("ending", "magic"), [("png", b"\x89PNG"), ("svg", b"<?xml"), ("pdf", b"%PDF")])
def test_formats_by_ending_and_the_same_file_each_time(body, tmp_path, ending, magic):
    out = tmp_path / f"page.{ending.upper()}"
    assert plot(body, out, "height").path == out
    first = out.read_bytes()
    assert first.startswith(magic)
    plot(body, out, "height", replace=True)
    assert out.read_bytes() == first


@pytest.mark.parametrize("name", FIGURES)
def test_each_figure_alone(pendulum, name):
    view = LogView(read(pendulum), 0.3, 2.0)
    words = texts(single(view, "header", name))
    missing = {word.removeprefix("not in this log: ") for word in words if word.startswith("not in this log")}
    body = {"torques": "/torque", "solver": "/wbc", "joints": "/measurement", "grip": "/measurement"}
    assert missing == ({body[name]} if name in body else set())
    if name == "solver":
        assert "WBC fallback: not logged" in words


def test_a_page_lies_beside_its_log_by_default(pendulum):
    start = time.process_time()
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        drawn = plot(pendulum)
    assert drawn.path == pendulum.with_name("figures.png")
    assert drawn.notes == ()
    assert time.process_time() - start < 10.0


def test_bounds_are_those_of_the_polygon(pendulum):
    view, log = LogView(read(pendulum)), read(pendulum)
    time, low, high = support_bounds(view, 1)
    assert np.isfinite([low, high]).all()
    alone = np.flatnonzero(log["/reference"].field("stance") == 1)[10:-10]
    polygon = log["/reference"].field("support")[alone, :, 1] - log["/truth"].field("right_sole")[alone, 1:2]
    rows = np.searchsorted(time, view.time("/reference")[alone], side="right") - 1
    np.testing.assert_allclose(low[rows], polygon.min(axis=1), atol=1e-6)
    np.testing.assert_allclose(high[rows], polygon.max(axis=1), atol=1e-6)
    assert len(time) < len(view.time("/reference")) / 10


def test_a_long_run_is_drawn_in_strips_that_show_all_of_it(pendulum):
    view = LogView(read(pendulum))
    assert strips(view) == ((view.start, view.end),)
    view.end = view.start + 30.0
    assert [end - start for start, end in strips(view)] == pytest.approx([10.0, 10.0, 10.0])
    figure = single(view, "header", "balance")
    shown = [axes.get_xlim() for axes in figure.findobj(Axes) if axes.get_ylabel() == "forward [m]"]
    assert shown == [pytest.approx(stretch) for stretch in strips(view)]
    short = single(LogView(read(pendulum)), "header", "balance")
    assert figure.get_size_inches()[1] > short.get_size_inches()[1] + 4
    view.end = view.start + 6000.0
    assert len(strips(view)) == 6


def test_a_strip_of_a_walk_is_drawn_in_rows_that_cover_it(tmp_path, robot, motion, two_steps):
    long = LogView(read(run_scenario(two_steps, tmp_path, None, motion(speed=6.0, duration=2.0), robot).log))
    rows = [axes for axes in single(long, "header", "top-view").findobj(Axes) if axes.get_ylabel() == "y [m]"]
    assert len(rows) > 1
    edges = [edge for axes in rows for edge in axes.get_xlim()]
    x = long.field("/truth", "com", 3)[:, 0]
    assert edges[0] < x.min() < x.max() < edges[-1]
    assert edges[1:-1:2] == pytest.approx(edges[2::2])


def test_every_joint_is_drawn_against_its_range_and_its_speed(body):
    log = read(body)
    constants = {name: json.loads(log.metadata["run"][name]) for name in ("joint_names", "position_lower")}
    log.metadata["run"]["velocity_limit"] = json.dumps([2.0] * len(constants["joint_names"]))
    view = LogView(log)
    figure = single(view, "header", "joints")
    words = texts(figure)
    assert {"Joint angles in percent of half their range", "Joint speeds in percent of their limits"} <= set(words)
    names, _ = angles(view)
    assert names == tuple(constants["joint_names"])
    log.metadata["run"]["position_upper"] = json.dumps(log["/measurement"].field("joint_position")[0].tolist())
    np.testing.assert_allclose(angles(LogView(log))[1][0], 100.0)
    np.testing.assert_allclose(speeds(view)[1], 50.0 * view.field("/measurement", "joint_velocity", -1))
    log.metadata["run"]["velocity_limit"] = "[]"
    assert texts(single(LogView(log), "header", "joints")).count("not in this log: a speed limit for each joint") == 3


def test_the_yaw_moment_reaches_all_that_friction_holds_where_the_cone_ends():
    sole, friction = (0.22, 0.11), 0.7
    cone = wrench_cone(sole[0] / 2, sole[1] / 2, friction)
    rng = np.random.default_rng(0)
    wrenches = rng.uniform((-200, -200, 400, -20, -40, 0), (200, 200, 900, 20, 40, 0), (200, 6))
    wrenches = wrenches[(wrenches @ cone.T < -1.0).all(axis=1)]
    assert len(wrenches) > 50
    for sign in (1.0, -1.0):
        some = wrenches.copy()
        some[:, 5] = sign
        some[:, 5] /= yaw_moment_used(some, friction, sole)
        np.testing.assert_allclose(yaw_moment_used(some, friction, sole), 1.0)
        np.testing.assert_allclose((some @ cone.T).max(axis=1), 0.0, atol=1e-9)
    assert np.isinf(yaw_moment_used(np.array([[0.0, 0, 100, 0, 20, 0]]), friction, sole)).all()
    assert friction_used(np.array([[30.0, 40.0, 100.0, 0, 0, 0]]), 0.5, sole) == pytest.approx([1.0])


def test_a_sole_that_rolls_on_level_ground_keeps_the_grounds_friction(body, tmp_path):
    ticks, pitched = 5, Rotation.from_euler("zy", [0.4, 0.5])
    push = np.array([0.0, 0.0, 900.0])
    wrench = np.tile([*pitched.inv().apply(push), 0.0, 0.0, 0.0], (ticks, 1))
    soles = {"left_sole": np.tile([0.0, 0.0, 0.0, *pitched.as_quat()], (ticks, 1))}
    view = invented(tmp_path / "rolls.mcap", body, {"/measurement": {"wrench_left": wrench}, "/truth": soles})
    np.testing.assert_allclose(loaded_wrench(view, 0), np.tile([0.0, 0.0, 900.0, 0.0, 0.0, 0.0], (ticks, 1)), atol=1e-9)
    wrench[:, :3] *= 0.05
    view = invented(tmp_path / "light.mcap", body, {"/measurement": {"wrench_left": wrench}, "/truth": soles})
    assert np.isnan(loaded_wrench(view, 0)).all()


def test_landings_are_told_along_the_planned_foot(body, tmp_path):
    fields = {
        "planned": np.array([[1.0, 2.0, 0.0, np.pi / 2], [0.0, 0.0, 0.0, 0.0]]),
        "actual": np.array([[1.0, 2.01, 0.0, 0.0], [np.nan, 0.0, 0.0, 0.0]]),
        "foot": np.array([1.0, 0.0]),
        "index": np.array([7.0, 8.0]),
    }
    errors, feet, numbers = landing_errors(invented(tmp_path / "x.mcap", body, {"/footstep": fields}))
    np.testing.assert_allclose(errors, [[0.01, 0.0]], atol=1e-12)
    assert (feet.tolist(), numbers.tolist()) == ([1], [7])


def test_centres_of_pressure_lie_in_the_outline_of_the_sole(pendulum):
    figure = single(LogView(read(pendulum)), "header", "soles")
    drawn = [axes for axes in figure.findobj(Axes) if "sole" in axes.get_xlabel()]
    assert [axes.get_xlabel() for axes in drawn] == ["to the left [m], left sole", "to the left [m], right sole"]
    for axes in drawn:
        outline = axes.patches[0].get_bbox()
        points = np.concatenate([line.get_xydata() for line in axes.lines if len(line.get_xydata())])
        assert len(points) > 10
        assert np.abs(points[:, 0]).max() <= outline.x1 + 1e-3
        assert np.abs(points[:, 1]).max() <= outline.y1 + 1e-3
        assert axes.get_xlim()[0] > axes.get_xlim()[1]  # left is on the left
        assert {text.get_text() for text in axes.get_legend().get_texts()} == {"single support", "double support"}


def test_the_dcm_is_the_coms_position_and_velocity_over_omega(pendulum):
    log = read(pendulum)
    truth, omega = log["/truth"], log["/reference"].field("omega")[:, None]
    expected = truth.field("com")[:, :2] + truth.field("com_velocity")[:, :2] / omega
    np.testing.assert_allclose(true_dcm(LogView(log)), expected, atol=1e-12)


def test_positions_are_seen_from_the_sole_that_bears(pendulum):
    log = read(pendulum)
    view, stance = LogView(log), log["/reference"].field("stance")
    clock, zmp = view.time("/contact"), view.field("/contact", "zmp", 3)[:, :2]
    seen = view.from_stance(clock, zmp)
    alone = np.flatnonzero(stance == 1)[10:-10]
    foot = log["/truth"].field("right_sole")[alone, :2]
    np.testing.assert_allclose(seen[alone], zmp[alone] - foot, atol=1e-6)  # which does not turn
    assert 1 <= np.isnan(seen[:, 0]).sum() <= 4  # a break at each change of the stance foot


def test_a_turned_foot_looks_along_itself(log_of):
    view = log_of(stance=[-1, 0, 0, -1, 1], left=(1.0, 2.0, 0.0, np.pi / 2), right=(0.0, 0.0, 0.0, 0.0))
    seen = view.from_stance(view.time("/reference"), np.tile([1.0, 2.5], (5, 1)))
    np.testing.assert_allclose(seen[:4], np.tile([0.5, 0.0], (4, 1)), atol=1e-12)
    assert np.isnan(seen[4]).all()


@pytest.fixture
def log_of(pendulum, tmp_path):
    """A view of invented stance feet, one per second."""

    def make(stance, left, right):
        ticks, bears = len(stance), {"stance": np.array(stance, float)}
        feet = {"current_left": np.tile(left, (ticks, 1)), "current_right": np.tile(right, (ticks, 1))}
        return invented(tmp_path / "x.mcap", pendulum, {"/reference": bears, "/footsteps": feet})

    return make


def test_phases_pushes_and_falls_lie_behind(pendulum, tmp_path, robot, motion, two_steps):
    behind = background(LogView(read(pendulum)))
    singles = [stretch for stretch in behind.phases if stretch.value[0] == 2]
    assert [round(stretch.end - stretch.start, 2) for stretch in singles] == [0.6, 0.6]
    assert {stretch.value[1] for stretch in singles} == {0, 1}
    assert [(round(push.start, 2), round(push.end, 2)) for push in behind.pushes] == [(1.0, 1.1)]
    assert behind.fall is None
    fallen = run_scenario(two_steps, tmp_path, None, motion(fall_at=1.0), robot).log
    assert background(LogView(read(fallen))).fall == 1.0
    assert background(LogView(read(fallen), 1.5)).fall is None


def test_stretches_cover_the_time_without_overlap():
    found = stretches(np.arange(6.0), np.array([[0], [0], [1], [1], [1], [2]]))
    assert [(one.start, one.end, one.value) for one in found] == [(0, 2, (0,)), (2, 5, (1,)), (5, 5, (2,))]


def test_joints_are_grouped_by_the_roles_that_a_log_tells():
    found = groups(("a", "b", "c", "d"), {"left_leg": ("b",), "right_leg": ("d", "a")})
    assert (found["left leg"], found["right leg"]) == ({"b": [1]}, {"a": [0], "d": [3]})
    assert found["upper body"] == {"c": [2]}


def test_joints_are_grouped_by_leg():
    names = ("left_hip_yaw", "right_knee", "waist_roll", "left_elbow", "neck_pitch", "leg_left_6_joint")
    found = groups(names, {})
    assert found["left leg"] == {"hip yaw": [0], "6": [5]}
    assert found["right leg"] == {"knee": [1]}
    assert found["upper body"] == {"waist roll": [2], "arms and head, largest": [3, 4]}


def test_times_of_idle_ticks_do_not_count():
    time, values = np.arange(10.0), np.array([0, 5, 0, 7, 0, 9, 0, 1, 0, 3.0])
    middle, median, greatest = stretch_extremes(time, values, 2)
    assert (middle.tolist(), median.tolist(), greatest.tolist()) == ([3.0, 8.0], [7.0, 2.0], [9.0, 3.0])
    assert len(stretch_extremes(time, np.zeros(10), 2)[0]) == 0


def test_a_strip_of_a_walk_gets_a_row_of_its_own(pendulum, tmp_path, robot, motion, two_steps):
    assert not is_wide(LogView(read(pendulum)))
    long = run_scenario(two_steps, tmp_path, None, motion(speed=2.0, duration=2.0), robot).log
    assert is_wide(LogView(read(long)))
    with warnings.catch_warnings():
        warnings.simplefilter("error")  # matplotlib warns where figures do not fit their row
        plot(long, tmp_path / "wide.png")


def test_absurd_values_are_gaps(pendulum, tmp_path, robot, motion, two_steps):
    far = run_scenario(two_steps, tmp_path, None, motion(speed=1e300, duration=2.0), robot).log
    assert np.isnan(LogView(read(far)).field("/truth", "com", 3)).any()
    plot(far, tmp_path / "x.png", "top-view")


def test_missing_fields_are_named(body):
    view = LogView(read(body))
    with pytest.raises(MissingError, match="/truth com of shape"):
        view.field("/truth", "com", 4)
    with pytest.raises(MissingError, match="/truth coma"):
        view.field("/truth", "coma", 3)
    with pytest.raises(MissingError, match="/footsteps"):
        view.time("/footsteps")


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"start": 90.0}, "holds nothing from 90 s on; choose --from and --to within 0 to"),
        ({"start": 1.0, "end": 0.5}, "holds nothing from 1 to 0.5 s"),
        ({"end": -1.0}, "holds nothing up to -1 s"),
        ({"start": float("nan")}, "holds nothing from nan s on"),
        ({"what": "torque"}, "--what torque: no such figure; did you mean 'torques'"),
        ({"what": "../x"}, "no such figure"),
    ],
)
def test_nothing_to_draw_is_said_in_one_sentence(pendulum, tmp_path, arguments, message):
    with pytest.raises(LogError, match=message):
        plot(pendulum, tmp_path / "x.png", **arguments)
    assert not (tmp_path / "x.png").exists()


@pytest.mark.parametrize("name", ["x", "x.jpg", "x.mcap", "no/such/x.png"])
def test_files_that_cannot_be_written(pendulum, tmp_path, name):
    with pytest.raises(LogError, match=r"end the file's name|cannot be written"):
        plot(pendulum, tmp_path / name, "height")


def test_constants_of_another_version_are_read_one_by_one(body):
    log = read(body)
    log.metadata["run"] = {"mass": "100", "foot_length": "0", "seed": "{", "joint_names": "[1]", "torque_limit": "7"}
    view = LogView(log)
    assert view.number("mass") == 100.0
    for name in ("foot_length", "foot_width", "seed"):
        with pytest.raises(MissingError, match=f"{name} of the run"):
            view.number(name)
    words = texts(page(view, "header"))
    assert "weight 981 N" in words
    assert words.count("not in this log: a torque limit for each joint") == 3


def test_a_log_without_messages(tmp_path):
    with LogWriter(tmp_path / "empty.mcap", {}):
        pass
    with pytest.raises(LogError, match="holds no messages to draw"):
        plot(tmp_path / "empty.mcap", tmp_path / "x.png")
