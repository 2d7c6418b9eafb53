"""Walkers beside each other: laws of what is measured of them, and the command with a policy that stands."""

import csv
import json
import math

import mujoco
import numpy as np
import pytest
from fake_walks import alone
from needs import POLICY
from typer.testing import CliRunner

from surefoot.planner.types import Twist
from surefoot.scenarios.cli.program import app
from surefoot.scenarios.errors import ScenarioError
from surefoot.studies.tour import drill
from surefoot.studies.tour.drill import MOST, VELOCITIES, velocities
from surefoot.studies.tour.rows import ROWS
from surefoot.studies.tour.side import FIGURE, JOURNAL, MEASURES, TABLE, Side, pushes, read_table, table
from surefoot.studies.tour.side_page import figure, markdown

pytestmark = pytest.mark.unit


def test_velocities_fill_their_ranges_and_are_a_seeds_own():
    drawn = np.array([tuple(twist)[:3] for seed in range(100) for twist in velocities(seed)])
    assert drawn.shape == (100 * VELOCITIES, 3)
    assert (np.abs(drawn) <= MOST).all() and (np.abs(drawn).max(axis=0) > 0.98 * np.array(MOST)).all()
    assert list(velocities(3)) == list(velocities(3)) != list(velocities(4))


@pytest.mark.parametrize("twist", [Twist(0.3, -0.1, 0.4), Twist(0.2, 0.0, 0.0), Twist(-0.3, 0.2, -0.5)])
def test_a_body_that_does_what_it_is_told_makes_no_error(twist):
    pose, steps, time = np.array([0.3, -0.2, 1.1]), 4000, 2.0
    before = pose.copy()
    for _ in range(steps):
        middle = pose[2] + 0.5 * twist.yaw * time / steps
        cos, sin = math.cos(middle), math.sin(middle)
        pose += np.array([cos * twist.x - sin * twist.y, sin * twist.x + cos * twist.y, twist.yaw]) * time / steps
    assert drill._error(before, pose, time, twist) == pytest.approx(np.zeros(3), abs=1e-6)
    faster = Twist(twist.x + 0.1, twist.y, twist.yaw)
    assert drill._error(before, pose, time, faster) == pytest.approx([-0.1, 0.0, 0.0], abs=1e-6)


def test_a_sole_that_slides_slips_and_one_that_rolls_about_its_edge_does_not():
    world = drill.Drill(ROWS["contract"]).world
    wrench = np.zeros((2, 6))
    wrench[:, 2] = 150.0
    world.data.qvel[:] = 0.0
    world.data.qvel[0] = 0.2
    mujoco.mj_forward(world.model, world.data)
    assert world.slipping(wrench) == pytest.approx([0.2, 0.2])
    assert not world.slipping(np.zeros((2, 6))).any()
    # The body turns about an axis along y through the toes, where the force acts.
    site = world.model.site(ROWS["contract"].walker().robot.sole_sites[0]).id
    toe = world.data.site_xpos[site] + np.array([0.08, 0.0, 0.0])
    world.data.qvel[:3] = np.cross((0.0, 1.0, 0.0), np.array(world.data.qpos[:3]) - toe)
    world.data.qvel[3:6] = (0.0, 1.0, 0.0)
    mujoco.mj_forward(world.model, world.data)
    wrench[:, 4] = -0.08 * 150.0
    assert world.slipping(wrench)[0] == pytest.approx(0.0, abs=1e-3)


def rows_of(**thresholds):
    rows = []
    for number, (name, values) in enumerate(thresholds.items()):
        measured = {measure: {"value": 1.0 + number, "count": 2} for measure in MEASURES}
        rows.append({"row": name, "fell": [number, 4], "thresholds": values, **measured})
    return {"seeds": 2, "rows": rows, "measures": MEASURES, "pushes": pushes()}


def test_who_wins_where_is_counted_and_ties_count_for_both():
    told = rows_of(mine=[0.5] * 8, theirs=[1.0] * 7 + [0.49])
    page = markdown(told)
    assert f"- `mine`: {len(MEASURES)} of {len(MEASURES)} of walking, 1 of 8 pushes" in page
    assert f"- `theirs`: 0 of {len(MEASURES)} of walking, 8 of 8 pushes" in page
    assert "| forward, mid-swing | 0.5 | **1** |" in page and "| fell | 0 of 4 | 1 of 4 |" in page


def test_the_table_is_read_back_and_the_figure_shows_each_walker():
    told = rows_of(mine=[0.5] * 7 + [None], theirs=[1.0] * 8)
    again = read_table([[str(cell) for cell in row] for row in table(told)])
    assert again == told and markdown(again) == markdown(told)
    drawn = figure(told)
    for axes in drawn.axes:
        curves = {line.get_label(): line.get_ydata() for line in axes.lines}
        assert np.allclose(curves["theirs"], 1.0) and set(curves) == {"mine", "theirs"}
        assert set(np.round(axes.get_xticks(), 6)) == set(np.round(np.arange(4) * 0.5 * math.pi, 6))


@pytest.mark.parametrize("words", [["--start", "crane"], ["--draws", "benchmark"], ["--seconds", "5"], ["--row", "no"]])
def test_options_of_the_tour_are_refused(words, tmp_path):
    done = CliRunner().invoke(app, ["bench", "g1-side", *words, "--out", str(tmp_path / "out")])
    assert isinstance(done.exception, ScenarioError) and not (tmp_path / "out").exists()


@pytest.mark.physics
def test_a_policy_that_stands_is_never_pushed_in_a_step_and_the_command_goes_on(tmp_path, monkeypatch):
    POLICY.or_skip()
    import policies

    from surefoot.studies.tour import side as module
    from surefoot.studies.tour.entrants import entrants

    monkeypatch.setattr(drill, "VELOCITIES", 1)
    monkeypatch.setattr(drill, "LATEST", 0.5)
    monkeypatch.setattr(module, "PLACES_TIME", 1.0)
    alone(monkeypatch, module)
    stander = policies.stander(tmp_path / "stander").parent
    out = tmp_path / "out"
    side = Side(entrants((), [stander]), 1, out)
    assert len(side.left()) == 2 + 8
    side.run(1)
    side.write()
    told = json.loads((out / "result.json").read_text())
    (row,) = told["rows"]
    assert row["thresholds"] == [None] * 8
    assert (out / FIGURE).read_text().startswith("<?xml") and "stander" in (out / TABLE).read_text()
    with (out / TABLE).open(newline="") as file:
        assert read_table(list(csv.reader(file)))["rows"][0]["thresholds"] == [None] * 8
    lines = (out / JOURNAL).read_text().splitlines()
    (out / JOURNAL).write_text("\n".join(lines[:-2]) + "\n" + lines[-2][:20])
    assert len(Side(entrants((), [stander]), 1, out).left()) == 2
