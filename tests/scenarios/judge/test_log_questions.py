"""Questions to a log: the stretches of time in which they hold, of a log in parts as of the whole."""

import json
import re
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from surefoot.scenarios.columns import Memory
from surefoot.scenarios.errors import LogError
from surefoot.scenarios.judge.balance import MARGIN, zmp_depth, zmp_edge
from surefoot.scenarios.judge.digest import RunView
from surefoot.scenarios.judge.questions import Condition, both, conditions, holding, stretches
from surefoot.scenarios.log import ChannelSpec, FieldSpec, LogWriter, read
from surefoot.scenarios.run.run import run_scenario

pytestmark = pytest.mark.unit

TICK_NS = 2_000_000
VALUES = st.lists(st.sampled_from([0.0, 1.0, 2.0, float("nan")]), min_size=1, max_size=30)


def found_in(time, values, condition, cuts=()):
    parts = zip(np.split(time, cuts), np.split(values, cuts), strict=True)
    found, last = holding(parts, condition)
    assert last == time[-1]
    return found


@given(values=VALUES, cuts=st.lists(st.integers(0, 30), max_size=3), sign=st.sampled_from(["<", ">=", "==", "!="]))
def test_a_tick_is_in_a_stretch_where_the_condition_holds_there(values, cuts, sign):
    time, condition = 0.1 * np.arange(len(values)), Condition("", "x", sign, 1.0)
    found = found_in(time, np.array(values), condition, sorted(min(cut, len(values)) for cut in cuts))
    holds = {"<": lambda v: v < 1, ">=": lambda v: v >= 1, "==": lambda v: v == 1, "!=": lambda v: v in (0.0, 2.0)}
    for at, value in zip(time[:-1], values[:-1], strict=True):
        assert any(one.start <= at < one.end for one in found) == holds[sign](value)
    assert any(one.end == np.inf for one in found) == holds[sign](values[-1])
    assert found == found_in(time, np.array(values), condition)
    assert all(one.end < other.start for one, other in pairwise(found))


def test_the_worst_value_is_the_one_farthest_beyond_the_bound():
    time, values = np.arange(5.0), np.array([3.0, 0.5, 0.2, 0.4, 3.0])
    (low,) = found_in(time, values, Condition("", "x", "<", 1.0), [2])
    assert low == (1.0, 4.0, 0.2, 2.0)
    first, last = found_in(time, values, Condition("", "x", ">", 1.0))
    assert (first.end, last.start, last.end, last.worst) == (1.0, 4.0, np.inf, 3.0)


@given(some=VALUES, others=VALUES)
def test_two_conditions_hold_where_both_do(some, others):
    """Held from message to message; topics of unlike rates."""
    quick, slow = 0.1 * np.arange(len(some)), 0.25 * np.arange(len(others))
    one = found_in(quick, np.array(some), Condition("", "x", "<", 1.5))
    other = found_in(slow, np.array(others), Condition("", "y", "<", 1.5))
    common = list(both(one, other))
    middles = np.arange(0.0, 8.0, 0.01) + 0.005

    def within(found, at):
        return any(each.start < at < each.end for each in found)

    for at in middles:
        assert within(common, at) == (within(one, at) and within(other, at))


@pytest.fixture(scope="module")
def log(tmp_path_factory):
    path = tmp_path_factory.mktemp("log") / "log.mcap"
    with LogWriter(path, {"run": {"joint_names": json.dumps(["left_knee", "right_knee"])}}) as writer:
        quick = writer.channel(ChannelSpec("/x", "X", (FieldSpec("a", (2,), "m"), FieldSpec("n", kind="int"))))
        slow = writer.channel(ChannelSpec("/y", "Y", (FieldSpec("a", (2,), "m"), FieldSpec("b", unit="s"))))
        for tick in range(1000):
            quick.append(tick * TICK_NS, np.array([np.sin(0.02 * tick), tick]), tick % 7)
            if tick % 10 == 0:
                slow.append(tick * TICK_NS, np.zeros(2), tick / 1000)
    return read(path)


def test_columns_of_topics_are_asked_by_name(log):
    (found,), units = stretches(log, "b >= 0.5")
    assert (found.start, found.end, units) == (1.0, 1.98, ("s",))
    found, units = stretches(log, "/x:a_1 < 100 and b >= 0.1")
    assert found == [] and units == ("m", "s")
    (found,), _ = stretches(log, "/x:a_1 <= 100 and b >= 0.1")
    assert (found.start, found.end) == (0.2, 0.202)
    (found,), _ = stretches(log, "a_1 < 300", topics=("/x",), start=0.1, end=0.3)
    assert (found.start, found.end) == (0.1, 0.3)


def test_what_holds_at_the_last_message_alone_is_a_stretch(log):
    (found,), _ = stretches(log, "/x:a_1 >= 999")
    assert found == (1.998, 1.998, 999.0, 1.998)
    (found,), _ = stretches(log, "/x:a_1 >= 999 and n == 5")
    assert (found.start, found.end) == (1.998, 1.998)
    assert stretches(log, "/x:a_1 >= 999 and n == 4")[0] == []


def test_the_answer_is_that_of_a_log_in_parts(log):
    whole = stretches(log, "n == 3")
    assert stretches(read(log.path, Memory(window=0.11)), "n == 3") == whole
    assert len(whole[0]) == 143


@pytest.mark.parametrize(
    ("question", "said"),
    [
        pytest.param("a_0 < 1", "a_0 is of 2 topics; write /x:a_0 or /y:a_0", id="of two topics"),
        pytest.param("/x:a < 1", "has no quantity a; its elements are a_0, a_1", id="a vector"),
        pytest.param("zmp_egde < 1", "has no quantity zmp_egde; did you mean 'zmp_edge'", id="misspelt"),
        pytest.param("zmp_edge < 1", "zmp_edge needs topic /truth, which is not there", id="without its topics"),
        pytest.param("/z:a_0 < 1", "no topic '/z'", id="no topic"),
        pytest.param("a_0", "'a_0' is no condition; write it as", id="no bound"),
        pytest.param("n < nan", "'n < nan' is no condition", id="not a number"),
        pytest.param("n < 1 and", "'' is no condition", id="nothing behind and"),
        pytest.param("n < 1 or n > 2", "'n < 1 or n > 2' is no condition", id="or"),
        pytest.param("", "'' is no condition", id="empty"),
    ],
)
def test_what_is_no_question_is_refused_in_a_sentence(log, question, said):
    with pytest.raises(LogError, match=re.escape(said)):
        stretches(log, question)


def test_conditions_are_read_as_they_are_written():
    assert conditions("zmp_edge<1e-2 and /truth:torso_tilt >= .2") == (
        Condition("", "zmp_edge", "<", 0.01),
        Condition("/truth", "torso_tilt", ">=", 0.2),
    )
    assert [one.text for one in conditions(" /x:q.left_knee != 0 ")] == ["/x:q.left_knee != 0"]


def test_the_edge_of_the_zmp_is_the_margin_of_shrunk_feet_without_the_shrinking(tmp_path, motion, two_steps, robot):
    path = run_scenario(two_steps, tmp_path, simulate=motion(duration=2.2), robot=robot).log
    run = RunView(read(path))
    edge, depth = zmp_edge(run), zmp_depth(run)
    sound = np.isfinite(edge)
    half = 0.5 * min(run.constants.foot_length, run.constants.foot_width)
    assert sound.any() and np.all(edge[sound] >= depth[sound] + (1 - MARGIN) * half - 1e-9)
    bound = float(np.median(edge[sound]))
    found, units = stretches(read(path), f"zmp_edge < {bound!r}")
    inside = np.any([(run.time >= one.start) & (run.time < one.end) for one in found], axis=0)
    assert units == ("m",) and np.array_equal(inside[:-1], (edge < bound)[:-1])
