"""Figures and replays of a log of any length: what is drawn in parts is the same, and a window reads its own chunks."""

from pathlib import Path

import numpy as np
import pytest
from matplotlib.figure import Figure
from spoilt import opened, spoil

import surefoot
from benchmarks.lengthened import lengthened
from benchmarks.memory import COMMANDS, MOST, measured
from surefoot.scenarios.columns import Memory
from surefoot.scenarios.judge.digest import RunView, Window
from surefoot.scenarios.log import read
from surefoot.scenarios.run.run import run_scenario
from surefoot.scenarios.show.figures.page import page, single
from surefoot.scenarios.show.kit.shading import background
from surefoot.scenarios.show.logview import LogView
from surefoot.scenarios.show.replay.content import ReplayWindow
from surefoot.scenarios.show.replay.extract import READS, choose_frames


@pytest.fixture(scope="module")
def log(tmp_path_factory, motion, two_steps, robot):
    return run_scenario(two_steps, tmp_path_factory.mktemp("log"), simulate=motion(duration=2.2), robot=robot).log


def extremes(figure: Figure):
    """Range of each curve by axes and label, of one that is drawn in parts that of all of them."""
    found = {}
    for number, axes in enumerate(figure.get_axes()):
        for line in axes.lines:
            values = np.asarray(line.get_ydata(), float)
            label = str(line.get_label()).removeprefix("_")
            if np.isfinite(values).any() and not label.startswith("child"):
                low, high = found.get((number, label), (np.inf, -np.inf))
                found[number, label] = min(low, np.nanmin(values)), max(high, np.nanmax(values))
    return found


def entries(figure: Figure):
    """Labels of the legends."""
    legends = [axes.get_legend() for axes in figure.get_axes()]
    return [[text.get_text() for text in one.get_texts()] for one in legends if one is not None]


@pytest.mark.unit
@pytest.mark.parametrize("name", ["balance", "height", "feet", "grip", "torques", "joints", "solver", "top-view"])
def test_a_figure_in_parts_has_the_curves_of_the_whole(log, name):
    whole, view = single(LogView(read(log)), "whole", name), LogView(read(log, Memory(drawn=0.5)))
    assert len(list(view.parts())) > 3
    parts = single(view, "parts", name)
    assert entries(parts) == entries(whole)
    assert extremes(parts).keys() == extremes(whole).keys()
    for key, found in extremes(whole).items():
        assert extremes(parts)[key] == pytest.approx(found, rel=1e-9, abs=1e-9)
    limits = [[axes.get_ylim() for axes in figure.get_axes()] for figure in (whole, parts)]
    assert np.allclose(*limits, rtol=0.05, atol=1e-6)


@pytest.mark.unit
def test_a_page_reads_what_it_draws_in_one_pass(log, tmp_path):
    view = LogView(opened(log, tmp_path))
    spoil(view.log)
    page(view, "one pass")
    assert not view.log.damage


@pytest.mark.unit
def test_a_plot_of_a_window_reads_the_chunks_of_that_window(log, tmp_path):
    spoilt = opened(log, tmp_path)
    own = spoil(spoilt, lambda chunk: chunk.start_ns <= 1_200_000_000 and chunk.end_ns >= 1_000_000_000)
    assert 0 < own <= 4
    drawn, whole = (single(LogView(one, 1.0, 1.2), "part", "feet") for one in (spoilt, read(log)))
    assert not spoilt.damage
    assert extremes(drawn) == extremes(whole)
    single(LogView(spoilt), "whole", "feet")
    assert len(spoilt.damage) > 15, "the whole is read"


@pytest.mark.unit
def test_a_fall_before_a_window_is_not_drawn_at_its_begin(tmp_path, motion, two_steps, robot):
    fallen = run_scenario(two_steps, tmp_path, simulate=motion(duration=2.2, fall_at=1.0), robot=robot).log
    whole = background(LogView(read(fallen))).fall
    assert whole is not None
    assert background(LogView(read(fallen), whole - 0.1)).fall == pytest.approx(whole)
    assert background(LogView(read(fallen), None, whole - 0.01)).fall is None
    assert background(LogView(read(fallen), whole + 0.01)).fall is None


@pytest.mark.unit
def test_a_page_with_too_many_frames_has_fewer_of_each_second(log):
    opened = read(log)
    run = RunView(Window(opened, opened.gather(READS)))
    every = choose_frames(run, ReplayWindow(), opened.time_range())
    few = choose_frames(run, ReplayWindow(most=10), opened.time_range())
    assert every.rate == 30.0
    assert len(every.time) > 40
    assert 7 <= len(few.time) <= 10
    assert few.rate < 30.0
    assert few.time[-1] > 0.8 * every.time[-1]


@pytest.fixture(scope="module")
def twenty_minutes(tmp_path_factory) -> Path:
    folder = tmp_path_factory.mktemp("twenty")
    walk = surefoot.run("walk-level", out=folder).log
    return lengthened(walk, folder / "twenty.mcap", 1200.0)


@pytest.mark.long
@pytest.mark.parametrize("what", COMMANDS)
def test_no_command_holds_a_long_log(twenty_minutes, tmp_path, what):
    peak, _ = measured(COMMANDS[what], twenty_minutes, tmp_path)
    assert 20e6 < peak.own < MOST
