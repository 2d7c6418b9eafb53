"""The page's side of a drive: what it sends is checked, what it shows is what a log of the same run would show."""

from typing import Any

import numpy as np
import pytest

import surefoot
from surefoot.apps.drive.page import LIMITS, read_input
from surefoot.apps.drive.picture import Pictures
from surefoot.apps.drive.session import GaitInput, PaceInput, PushInput, Reset
from surefoot.planner.types import Twist
from surefoot.scenarios.show.logview import LogView
from surefoot.scenarios.show.replay.content import ReplayWindow
from surefoot.scenarios.show.replay.extract import extract
from surefoot.scenarios.show.replay.page import CHARTS
from surefoot.similarity import Similarity

pytestmark = pytest.mark.unit

BRIEF = {"duration": 0.6, "gait.initial_stand": 0.1, "gait.single_support": 0.4, "gait.double_support": 0.1}


def test_inputs_are_read_and_bent_into_what_may_be_asked_for():
    assert read_input("velocity", {"v_x": 0.3, "v_y": -9, "yaw_rate": 0}) == Twist(0.3, -LIMITS.y, 0.0)
    assert read_input("gait", {"swing_height": 0.07}) == GaitInput(swing_height=0.07)
    assert read_input("pace", {"paused": True}) == PaceInput(paused=True)
    assert read_input("pace", {"speed": 0.25}) == PaceInput(speed=0.25)
    assert read_input("pace", {"speed": 0.01}) == PaceInput(speed=0.1)
    assert read_input("reset", {}) == Reset()
    small = Similarity(0.25, 0.02)
    assert read_input("velocity", {"v_x": 9, "v_y": 0, "yaw_rate": 9}, small) == Twist(0.3, 0.0, 1.2)
    assert read_input("gait", {"swing_height": 0.07}, small) == GaitInput(swing_height=0.03)


@pytest.mark.parametrize(
    ("kind", "given"),
    [
        ("velocity", {"v_x": 0.3}),
        ("velocity", {"v_x": "fast", "v_y": 0.0, "yaw_rate": 0.0}),
        ("velocity", {"v_x": float("nan"), "v_y": 0.0, "yaw_rate": 0.0}),
        ("velocity", {"v_x": True, "v_y": 0.0, "yaw_rate": 0.0}),
        ("velocity", {"v_x": 10**400, "v_y": 0.0, "yaw_rate": 0.0}),
        ("velocity", {"v_x": [[]], "v_y": 0.0, "yaw_rate": 0.0}),
        ("gait", {"single_support": None}),
        ("pace", {"speed": 0.0}),
        ("pace", {"speed": -(10**400)}),
        ("pace", {"paused": "x"}),
        ("pace", {"paused": 1}),
        ("pace", {"paused": None}),
        ("jump", {}),
        (["reset"], {}),
        (None, {}),
    ],
)
def test_what_the_page_would_not_send_is_refused(kind: str | None, given: dict[str, Any]) -> None:
    with pytest.raises(ValueError, match=r"no number|no input|give more than 0|give true or false"):
        read_input(kind, given)


def test_a_picture_shows_what_a_replay_of_the_log_shows(tmp_path):
    """Bodies, marks and charts in the single support of a walk, and a push."""
    scenario = surefoot.load("walk-level", {**BRIEF, "sensing.source": "truth"})
    log = tmp_path / "log.mcap"
    with surefoot.Simulation(scenario, log=log) as sim:
        pictures, seen = Pictures(sim.walk), []
        while not sim.done:
            if sim.time == 0.5:
                sim.push((20.0, -10.0, 0.0), duration=0.1)
                pictures.pushed(PushInput((2.0, -1.0, 0.0), sim.walk.robot.torso_body), sim.time)
            tick = sim.step()
            if round(1000 * tick.time) % 100 == 50:
                seen.append((pictures.picture(tick), pictures.values(tick)))
    opened = surefoot.read(log)
    replay = extract(opened, ReplayWindow(start=0.05, frame_rate=10.0))
    assert len(seen) == len(replay) == 6
    tracks = {(track.layer, track.name): track.vertices for track in replay.tracks}
    for frame, (picture, _) in enumerate(seen):
        assert picture.time[0] == pytest.approx(replay.time[frame])
        np.testing.assert_allclose(picture.body_position[0], replay.body_position[frame], atol=1e-9)
        np.testing.assert_allclose(picture.body_quaternion[0], replay.body_quaternion[frame], atol=1e-9)
        for track in picture.tracks:
            if track.layer != "Taken footprints":
                np.testing.assert_allclose(
                    track.vertices[0], tracks[track.layer, track.name][frame], atol=1e-6, err_msg=str(track)
                )
    assert np.isfinite(tracks["Pushes", "push"][-1]).all()
    view = LogView(opened)
    for number, chart in enumerate(CHARTS):
        drawn = chart.values(view, replay.time)
        assert tuple(drawn) == chart.curves
        for frame in (-2, -1):
            expected = seen[frame][1][number]
            assert [values[frame] for values in drawn.values()] == pytest.approx(expected, abs=1e-6)
