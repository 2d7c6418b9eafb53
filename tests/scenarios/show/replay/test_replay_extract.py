"""A replay shows what the log says."""

import contextlib
import random

import numpy as np
import pinocchio as pin
import pytest
from invented_log import PUSH, TOUCHDOWNS, cop, sole, wrench
from scipy.spatial.transform import Rotation

from surefoot.models.pinocchio import pinocchio_model
from surefoot.models.registry import describe
from surefoot.models.types import RobotOptions
from surefoot.scenarios.errors import LogError
from surefoot.scenarios.log import read
from surefoot.scenarios.show.replay.content import CONTACT_SCALE, PUSH_SCALE, PUSH_SHOWN, Replay, ReplayWindow, Track
from surefoot.scenarios.show.replay.extract import extract
from surefoot.scenarios.show.replay.video import marks_of

pytestmark = pytest.mark.unit


@pytest.fixture
def replay(log) -> Replay:
    return extract(log)


def track(replay: Replay, layer: str, name: str) -> Track:
    return next(track for track in replay.tracks if (track.layer, track.name) == (layer, name))


def test_frames_are_even_and_show_the_last_tick(replay, log):
    assert np.diff(replay.time) == pytest.approx(1 / 30)
    assert (replay.time[0], len(replay)) == (0.0, 30)
    ticks = log["/truth"].time
    for time, q in zip(replay.time, replay.configuration, strict=True):
        row = np.flatnonzero(ticks <= time + 1e-9)[-1]
        assert np.array_equal(q, log["/truth"].field("q")[row])


def test_body_poses_are_pinocchios(replay):
    model = pinocchio_model(describe("humanoid100", RobotOptions()))
    data = model.createData()
    for frame in (0, 13, 29):
        pin.framesForwardKinematics(model, data, replay.configuration[frame])
        for body, name in enumerate(replay.body_names[1:], start=1):
            pose = data.oMf[model.getFrameId(name, pin.FrameType.BODY)]
            rotation = Rotation.from_quat(replay.body_quaternion[frame, body], scalar_first=True).as_matrix()
            assert replay.body_position[frame, body] == pytest.approx(pose.translation, abs=1e-12)
            assert rotation == pytest.approx(pose.rotation, abs=1e-12)


def test_a_window(log):
    replay = extract(log, ReplayWindow(0.25, 0.5))
    assert replay.time[0] == 0.25
    assert 0.5 - 1 / 30 < replay.time[-1] <= 0.5 + 1e-9
    assert len(extract(log, ReplayWindow(0.5, 0.5))) == 1


def test_contact_forces_act_at_the_centre_of_pressure(replay):
    arrow = track(replay, "Contact forces", "left").vertices
    for frame in (0, 17):
        pose = sole(np.floor(replay.time[frame] * 500 + 1e-6) / 500, 0)
        rotation = Rotation.from_quat(pose[3:])
        assert arrow[frame, 0] == pytest.approx(pose[:3] + rotation.apply([*cop(0), 0.0]))
        assert arrow[frame, 1] - arrow[frame, 0] == pytest.approx(CONTACT_SCALE * rotation.apply(wrench(0)[:3]))


def test_a_foot_in_the_air_has_no_force(replay):
    assert not any(track(replay, "Contact forces", "right").shown(frame) for frame in range(len(replay)))


def test_a_push_shorter_than_a_frame_is_seen_for_a_while(replay):
    begin, end, force = PUSH
    push = track(replay, "Pushes", "push")
    shown = np.array([push.shown(frame) for frame in range(len(replay))])
    due = (replay.time >= begin) & (replay.time < end + PUSH_SHOWN - 0.005)
    assert np.array_equal(shown, due)
    frame = int(np.flatnonzero(shown)[0])
    tail, head = push.vertices[frame]
    assert head - tail == pytest.approx(PUSH_SCALE * force)
    pelvis = replay.body_position[frame, replay.body_names.index("pelvis")]
    assert np.linalg.norm(head - pelvis) < 0.2


def test_points(replay, log):
    rows = np.floor(replay.time * 500 + 1e-6).astype(int)
    assert np.array_equal(track(replay, "CoM", "measured").vertices[:, 0], log["/truth"].field("com")[rows])
    zmp = track(replay, "ZMP", "measured")
    assert np.array_equal(zmp.vertices[:, 0, :2], log["/contact"].field("zmp")[rows, :2], equal_nan=True)
    assert [zmp.shown(0), zmp.shown(29)] == [True, False]
    assert len(zmp.path(slice(None))) == np.count_nonzero(replay.time < 0.9)
    dcm = track(replay, "DCM", "measured").vertices[:, 0, :2]
    assert np.array_equal(dcm, log["/estimate"].field("dcm")[rows])


def test_support_polygon_lies_on_the_standing_foot(replay):
    polygon = track(replay, "Support polygon", "planned").vertices
    assert polygon[0, :4, :2].tolist() == [[-0.1, 0.1], [-0.1, 0.0], [0.1, 0.0], [0.1, 0.1]]
    assert np.all(np.abs(polygon[..., 2]) < 0.01)


def test_footprints_come_with_their_touchdowns(replay):
    assert [footprint.since for footprint in replay.footprints] == pytest.approx([0.0, 0.0, 0.4, 0.8])
    robot = describe("humanoid100", RobotOptions())
    for footprint, (_, _, pose) in zip(replay.footprints[2:], TOUCHDOWNS, strict=True):
        assert footprint.corners.mean(axis=0)[:2] == pytest.approx(pose[:2])
        edges = np.linalg.norm(footprint.corners - np.roll(footprint.corners, -1, axis=0), axis=1)
        assert edges == pytest.approx([robot.sole_length, robot.sole_width] * 2)
        forward = footprint.corners[0] - footprint.corners[1]
        assert np.arctan2(forward[1], forward[0]) == pytest.approx(pose[3])
    assert replay.footprints[2].color != replay.footprints[3].color


def test_planned_footprints_move_with_the_plan(replay):
    left = track(replay, "Planned footprints", "left, 1 ahead").vertices
    assert left[15].mean(axis=0)[0] == pytest.approx(0.2 + 0.5, abs=0.02)
    others = [t for t in replay.tracks if t.layer == "Planned footprints" and t.name != "left, 1 ahead"]
    assert not any(t.shown(15) for t in others)


def test_a_truncated_log_shows_what_it_holds(log_path, tmp_path):
    cut = tmp_path / "cut.mcap"
    cut.write_bytes(log_path.read_bytes()[: log_path.stat().st_size * 2 // 3])
    replay = extract(read(cut))
    assert 0.1 < replay.time[-1] < 0.9


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"fidelity": "pendulum"}, "a pendulum has no body to replay; run the scenario with fidelity full"),
        ({"world": b""}, "holds no readable world.xml"),
        ({"world": b"<mujoco><worldbody>"}, "world.xml is damaged"),
        ({"world": b"<mujoco/>"}, "are of different robots"),
        ({"duration": 0.0}, "ends before the first control tick"),
    ],
)
def test_a_log_without_a_replay_says_why(write_log, options, message):
    with pytest.raises(LogError, match=message):
        extract(read(write_log(**options)))


def test_flipped_bits_give_a_replay_or_a_sentence(write_log, tmp_path):
    whole, rng = write_log(duration=0.2).read_bytes(), random.Random(0)
    damaged = tmp_path / "damaged.mcap"
    for _ in range(60):
        content = bytearray(whole)
        content[rng.randrange(8, len(content))] ^= 1 << rng.randrange(8)
        damaged.write_bytes(content)
        with contextlib.suppress(LogError):
            replay = extract(read(damaged))
            assert all(np.isfinite(mark.ends).all() for mark in marks_of(replay, len(replay) - 1))


@pytest.mark.parametrize(
    "window", [ReplayWindow(5.0, None), ReplayWindow(None, -1.0), ReplayWindow(0.6, 0.5), ReplayWindow(float("nan"))]
)
def test_an_empty_window_says_what_there_is(log, window):
    with pytest.raises(LogError, match=r"nothing .*; the log goes from 0 s to 0\.998 s"):
        extract(log, window)
