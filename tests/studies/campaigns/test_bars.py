"""Bars of thresholds: each as high as its threshold, limits and published values where they belong, nothing cut off."""

import pytest
from matplotlib.colors import to_rgb

from surefoot.scenarios.many.points import Threshold
from surefoot.scenarios.palette import BLUE, VERMILION
from surefoot.studies.campaigns.spec import Axis, Published
from surefoot.studies.campaigns.thresholds import LIMIT_NAME, Found, are_named, bars

pytestmark = pytest.mark.unit

AXES = [Axis("way", ("fore", "aft")), Axis("level", ("none", "all")), Axis("phase", ("DS", "SS"))]
RANGE = (0.1, 2.0)


def height(labels):
    """A threshold of its own for each search."""
    places = [axis.values.index(labels[axis.name]) for axis in AXES]
    return 0.2 + 0.1 * places[0] + 0.04 * places[1] + 0.01 * places[2]


def search(way, level, phase, side="inside"):
    labels = {"way": way, "level": level, "phase": phase}
    return Found(labels, Threshold(height(labels) if side == "inside" else None, side), RANGE)


EVERY = [
    search(*labels) for labels in [(w, v, p) for w in AXES[0].values for v in ("none", "all") for p in ("DS", "SS")]
]


def drawn(found=EVERY, limit=lambda *_: None, records=()):
    """Visible panels by title."""
    figure = bars(found, AXES, "pushes.0.impulse", limit, records)
    figure.draw_without_rendering()
    return {one.get_title(): one for one in figure.axes if one.get_visible()}, figure


def limits_of(panel):
    return [line for line in panel.lines if line.get_label() == LIMIT_NAME]


def test_each_bar_is_as_high_as_its_threshold_by_group_and_shade():
    panels, _ = drawn()
    assert list(panels) == ["fore", "aft"]
    for way, panel in panels.items():
        found = sorted((bar.get_center()[0], bar.get_height(), to_rgb(bar.get_facecolor())) for bar in panel.patches)
        order = [(level, phase) for phase in ("DS", "SS") for level in ("none", "all")]
        assert [one[1] for one in found] == [height({"way": way, "level": v, "phase": p}) for v, p in order]
        assert found[1][2] == found[3][2] == pytest.approx(BLUE)
        assert sum(found[0][2]) > sum(BLUE)
        assert [label.get_text() for label in panel.get_xticklabels()] == ["DS", "SS"]


def test_what_lies_beyond_the_range_is_hollow_and_what_is_not_known_is_not_there():
    panels, _ = drawn([search("fore", "none", "DS", "below"), search("fore", "all", "SS", "above")])
    (low, high) = panels["fore"].patches
    assert (low.get_height(), high.get_height()) == RANGE
    assert to_rgb(low.get_facecolor()) == to_rgb(high.get_facecolor()) == (1.0, 1.0, 1.0)
    assert "aft" not in panels


def test_a_limit_lies_across_its_bar_or_is_told_at_the_edge_when_far_beyond():
    def limit(labels, _):
        return None if labels["phase"] == "DS" else 0.3 if labels["level"] == "none" else 7.0

    panels, _ = drawn(limit=limit)
    for panel in panels.values():
        (line,) = limits_of(panel)
        bar = sorted(panel.patches, key=lambda one: one.get_center()[0])[2]
        assert set(line.get_ydata()) == {0.3}
        assert bar.get_x() == pytest.approx(min(line.get_xdata()))
        assert [one.get_text() for one in panel.texts] == ["7 →"]
        assert panel.get_ylim()[1] < 1.0


def test_published_values_stand_at_their_group_or_across_all_and_whole():
    records = [
        Published(name="A", value=0.9, source="a", at={"way": "fore", "phase": "SS"}),
        Published(name="B", value=0.9, source="b", at={"way": "fore", "phase": "SS"}),
        Published(name="C", value=0.05, source="c", at={"way": "aft"}),
    ]
    panels, figure = drawn(records=records)
    marks = {line.get_label(): line for line in panels["fore"].lines}
    assert set(marks) == {"A", "B"}
    for line in marks.values():
        assert abs(line.get_xdata()[0] - 1.0) < 0.3
        assert to_rgb(line.get_color()) == VERMILION
    assert marks["A"].get_xdata() != marks["B"].get_xdata()
    assert panels["fore"].get_ylim()[1] > 0.9
    (across,) = panels["aft"].lines
    assert set(across.get_ydata()) == {0.05}
    told = [one.get_text() for one in figure.legends[0].get_texts()]
    assert told == ["none", "all", "A", "B", "C"]


def test_nothing_overlaps_or_leaves_the_figure():
    records = [Published(name=f"a name that is long, {i}", value=0.3, source="a", at={"way": "fore"}) for i in range(3)]
    panels, figure = drawn(limit=lambda *_: 0.3, records=records)
    whole, legend = figure.bbox, figure.legends[0].get_window_extent()
    assert whole.x0 <= legend.x0 and legend.x1 <= whole.x1
    boxes = [panel.get_tightbbox() for panel in panels.values()]
    assert not boxes[0].overlaps(boxes[1])
    assert not any(box.overlaps(legend) for box in boxes)


def test_an_axis_of_numbers_is_drawn_otherwise():
    assert are_named(AXES)
    assert not are_named([*AXES, Axis("gait.steps", (1, 2))])
    assert not are_named(AXES[:1])
