"""Figures of logs: what they are drawn from is right, and whatever is missing is said."""

import time
import warnings

import numpy as np
import pytest
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.text import Text

from surefoot.scenarios.errors import LogError
from surefoot.scenarios.log import LogWriter, read
from surefoot.scenarios.loop.run import run_scenario
from surefoot.scenarios.setup.load import load as load_scenario
from surefoot.scenarios.show.figures.effort import groups, stretch_extremes
from surefoot.scenarios.show.figures.motion import support_bounds, true_dcm
from surefoot.scenarios.show.figures.page import FIGURES, page, plot, single
from surefoot.scenarios.show.figures.shading import background, stretches
from surefoot.scenarios.show.figures.top_view import is_wide
from surefoot.scenarios.show.logview import LogView, MissingError

pytestmark = pytest.mark.unit

SHORT = ("fidelity=pendulum", "gait.steps=2", "gait.single_support=0.6", "gait.initial_stand=0.2", "rates.control=100")


@pytest.fixture(scope="module")
def pendulum(tmp_path_factory):
    scenario = load_scenario("diagonal-walk", (*SHORT, "pushes=[{time: 1, duration: 0.1, force: [5, 0, 0]}]"))
    return run_scenario(scenario, tmp_path_factory.mktemp("pendulum")).log


@pytest.fixture
def body(tmp_path, robot, motion, two_steps):
    return run_scenario(two_steps, tmp_path, None, motion(duration=2.0), robot).log


def texts(figure: Figure) -> list[str]:
    return [text.get_text() for text in figure.findobj(Text)]


def test_the_page_has_every_figure_with_units_on_its_axes(body):
    figure = page(LogView(read(body)), "header")
    labels = [axes.get_ylabel() for axes in figure.findobj(Axes)]
    assert len(labels) == 4 + 1 + 2 + 2 + 3 + 3
    assert [label for label in labels if "[" not in label] == [""]
    words = texts(figure)
    assert [word for word in words if "not in this log" in word] == ["not in this log: such joints"]
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
    assert missing == {"torques": {"/torque"}, "solver": {"/wbc"}}.get(name, set())
    if name == "solver":
        assert "WBC fallback: not logged" in words


def test_a_page_lies_beside_its_log_by_default(pendulum):
    start = time.perf_counter()
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        drawn = plot(pendulum)
    assert drawn.path == pendulum.with_name("figures.png")
    assert drawn.notes == ()
    assert time.perf_counter() - start < 10.0


def test_bounds_are_those_of_the_polygon(pendulum):
    view = LogView(read(pendulum))
    time, low, high = support_bounds(view, 1)
    polygon = read(pendulum)["/reference"].field("support")[..., 1]
    rows = np.searchsorted(time, view.time("/reference"), side="right") - 1
    np.testing.assert_array_equal(low[rows], polygon.min(axis=1))
    np.testing.assert_array_equal(high[rows], polygon.max(axis=1))
    assert len(time) < len(polygon) / 10


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
def log_of(pendulum, monkeypatch):
    """A view of invented stance feet, one per second."""

    def make(stance, left, right):
        view, ticks = LogView(read(pendulum)), len(stance)
        fields = {"stance": np.array(stance, float)}
        fields |= {"current_left": np.tile(left, (ticks, 1)), "current_right": np.tile(right, (ticks, 1))}
        monkeypatch.setattr(view, "field", lambda topic, name, *shape: fields[name])
        monkeypatch.setattr(view, "time", lambda topic: np.arange(float(ticks)))
        return view

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
