"""A log as a motion for trainers, and a motion of theirs beside a log."""

from pathlib import Path

import numpy as np
import pytest
import yaml

import surefoot
from surefoot.models.convert import Coordinates
from surefoot.scenarios.cli.program import program
from surefoot.scenarios.errors import LogError
from surefoot.scenarios.record.provenance import RunConstants
from surefoot.scenarios.show.motion import bodies_of, sampled, write_motion
from surefoot.scenarios.show.replay.content import ReplayWindow
from surefoot.scenarios.show.replay.extract import extract, world
from surefoot.scenarios.show.replay.reference import LAYER, read_motion

pytestmark = pytest.mark.physics

ROBOTS = ("humanoid100", "g1")
SHORT = {"gait.steps": 3, "gait.initial_stand": 0.2, "duration": 1.5}


@pytest.fixture(scope="module", params=ROBOTS)
def walked(request, tmp_path_factory):
    """A log of the first steps of a robot."""
    scenario = surefoot.load("walk-level", {"robot": request.param, **SHORT})
    path = tmp_path_factory.mktemp(request.param) / "log.mcap"
    with surefoot.Simulation(scenario, log=path) as sim:
        while not sim.done:
            sim.advance()
    return surefoot.read(path)


def main(words) -> int:
    """The exit code of a command."""
    with pytest.raises(SystemExit) as end:
        program(words)
    return end.value.code


def constants_of(log) -> RunConstants:
    return RunConstants.from_metadata(log.metadata, str(log.path))


def names_of(log) -> tuple[str, ...]:
    return constants_of(log).joint_names


def test_a_motion_read_back_is_the_log_at_those_times(walked, tmp_path):
    truth = walked["/truth"]
    fps = constants_of(walked).control_rate / 10.0
    for kind, precise in ((".npz", 2e-7), (".csv", 1e-8)):
        file = tmp_path / f"walk{kind}"
        found = write_motion(walked, file, fps)
        motion = read_motion(file, names_of(walked))
        assert len(motion) == len(found.time) == 1 + (len(truth) - 1) // 10
        q = truth.field("q")[::10]
        np.testing.assert_array_equal(found.q, q)
        read = motion.configurations(names_of(walked), np.zeros(q.shape[1] - 7))
        np.testing.assert_allclose(read, q, atol=precise * 4.0, rtol=0.0)
    assert not np.allclose(read[1:], q[:-1], atol=1e-6)  # a frame too early is not it


def test_between_ticks_it_is_between_them(walked):
    truth = walked["/truth"]
    found = sampled(walked, 123.0)
    rows = np.searchsorted(truth.time, found.time + 1e-9, side="right") - 1
    q = truth.field("q")
    low, high = (
        np.minimum(q[rows], q[np.minimum(rows + 1, len(q) - 1)]),
        np.maximum(q[rows], q[np.minimum(rows + 1, len(q) - 1)]),
    )
    assert (found.q >= low - 1e-9).all() and (found.q <= high + 1e-9).all()
    np.testing.assert_allclose(np.linalg.norm(found.q[:, 3:7], axis=1), 1.0, atol=1e-9)


def test_velocities_are_those_of_the_positions(walked):
    """Velocities agree with differences: bodies with their rotation, joints, and the base, in the world."""
    found = sampled(walked, 1.0 / np.diff(walked["/truth"].time).min())
    _, model = world(walked)
    assert Coordinates(model).size == found.q.shape[1]
    bodies, h = bodies_of(model, found.q, found.v), float(np.diff(found.time).mean())
    assert bodies.names[0] == model.body(1).name
    calm = np.abs(np.gradient(np.gradient(bodies.position, h, axis=0), h, axis=0)).max(axis=(1, 2)) < 20.0
    calm[[0, 1, -2, -1]] = False
    assert calm.mean() > 0.5
    moved = np.gradient(bodies.position, h, axis=0)
    np.testing.assert_allclose(moved[calm], bodies.velocity[calm], atol=0.05)
    assert np.abs(bodies.velocity[calm]).max() > 0.2
    np.testing.assert_allclose(bodies.position[:, 0], found.q[:, :3], atol=1e-9)
    w, x, y, z = np.moveaxis(bodies.quaternion, -1, 0)
    dw, dx, dy, dz = np.moveaxis(np.gradient(bodies.quaternion, h, axis=0), -1, 0)
    spin = 2.0 * np.stack([
        -dw * x + dx * w - dy * z + dz * y, -dw * y + dx * z + dy * w - dz * x, -dw * z - dx * y + dy * x + dz * w
    ], axis=-1)  # fmt: skip
    np.testing.assert_allclose(spin[calm], bodies.angular_velocity[calm], atol=0.2)


def test_the_file_has_what_trainers_read(walked, tmp_path):
    write_motion(walked, tmp_path / "walk.npz")
    with np.load(tmp_path / "walk.npz", allow_pickle=False) as file:
        found = {name: file[name] for name in file.files}
    n, b, k = len(found["root_pos"]), len(found["body_names"]), len(names_of(walked))
    assert (found["fps"].tolist(), tuple(found["joint_names"])) == ([50], names_of(walked))
    shapes = {
        "joint_pos": (n, k), "joint_vel": (n, k), "body_pos_w": (n, b, 3), "body_quat_w": (n, b, 4),
        "body_lin_vel_w": (n, b, 3), "body_ang_vel_w": (n, b, 3), "root_pos": (n, 3), "root_quat": (n, 4),
    }  # fmt: skip
    assert {name: found[name].shape for name in shapes} == shapes
    assert {found[name].dtype for name in shapes} == {np.dtype(np.float32)}
    np.testing.assert_allclose(found["root_quat"][:, 0], 1.0, atol=0.05)  # w first: it walks ahead
    np.testing.assert_array_equal(found["body_pos_w"][:, 0], found["root_pos"])
    assert found["contacts"].shape == (n, 2) and found["contacts"][0].all() and not found["contacts"].all()


def test_joints_come_in_the_order_of_a_contract(walked, tmp_path, capsys):
    names = names_of(walked)[::-2]
    contract = {"network": "none.onnx", "rate": 50, "joints": list(names), "stiffness": 1.0, "damping": 1.0}
    contract["observations"] = [{"term": "gravity"}]
    (tmp_path / "contract.yaml").write_text(yaml.safe_dump(contract))
    out = tmp_path / "walk.npz"
    words = ["motion", str(walked.path), "--out", str(out), "--fps", "25", "--from", "0.5"]
    assert main([*words, "--joints", str(tmp_path / "contract.yaml")]) == 0
    assert capsys.readouterr().out.strip() == str(out)
    motion = read_motion(out, names_of(walked))
    assert (motion.joint_names, motion.fps) == (names, 25.0)
    q = walked["/truth"].field("q")[int(np.searchsorted(walked["/truth"].time, 0.5 - 1e-9))]
    at = [names_of(walked).index(name) for name in names]
    np.testing.assert_allclose(motion.joint_position[0], q[7:][at], atol=1e-6)
    contract["joints"] = [*names, "no_such_joint"]
    (tmp_path / "contract.yaml").write_text(yaml.safe_dump(contract))
    assert main([*words, "--force", "--joints", str(tmp_path / "contract.yaml")]) == 2
    assert "no joint 'no_such_joint'" in capsys.readouterr().err


@pytest.mark.parametrize(
    "words, said",
    [
        (["--out", "walk.bvh"], "unknown kind of file '.bvh'"),
        (["--out", "walk.npz", "--fps", "-3"], "--fps -3: give a number"),
        (["--out", "walk.npz", "--fps", "nan"], "--fps nan: give a number"),
        (["--out", "walk.npz", "--from", "7"], "no two ticks in that time; the log is from 0.000 s"),
        (["--out", "walk.npz", "--fps", "999"], "give --fps"),
        (["--out", "there.npz"], "exists already"),
    ],
)
def test_what_is_no_motion_is_refused_in_a_sentence(walked, tmp_path, monkeypatch, capsys, words, said):
    monkeypatch.chdir(tmp_path)
    Path("there.npz").touch()
    before = sorted(tmp_path.iterdir())
    assert main(["motion", str(walked.path), *words]) == 2
    told = capsys.readouterr().err
    assert said in told and told.count("\n") == 1 and "Traceback" not in told
    assert sorted(tmp_path.iterdir()) == before


def test_a_pendulum_has_no_motion(tmp_path, capsys):
    scenario = surefoot.load("walk-level", {"fidelity": "pendulum", "duration": 0.2, "criteria": {"fell": False}})
    result = surefoot.run(scenario, out=tmp_path)
    assert main(["motion", str(result.log), "--out", str(tmp_path / "walk.npz")]) == 2
    assert "a pendulum has no joints" in capsys.readouterr().err


def test_a_motion_beside_its_own_log_lies_in_the_robot_and_another_one_does_not(walked, tmp_path):
    file = tmp_path / "walk.npz"
    write_motion(walked, file, 30.0)
    replay = extract(walked, ReplayWindow(0.5, None, beside=file))
    lines = [track for track in replay.tracks if track.layer == LAYER]
    assert len(lines) > 8 and LAYER in replay.legend()
    for track in lines:
        body = replay.body_names.index(track.name)
        np.testing.assert_allclose(track.vertices[:-1, 1], replay.body_position[:-1, body], atol=0.012)
    # One that goes elsewhere begins with the robot, and leaves it.
    with np.load(file) as held:
        other = {name: held[name].copy() for name in held.files}
    other["root_pos"] = (
        other["root_pos"] + np.array([3.0, -1.0, 0.0]) + np.arange(len(other["root_pos"]))[:, None] * 0.01
    )
    np.savez(file, **other)
    moved = extract(walked, ReplayWindow(None, None, beside=file))
    (line,) = [track for track in moved.tracks if (track.layer, track.name) == (LAYER, lines[0].name)]
    body = moved.body_names.index(line.name)
    off = np.linalg.norm(line.vertices[:, 1, :2] - moved.body_position[:, body, :2], axis=1)
    assert off[0] < 1e-3 and off[30] > 0.2
    # A shorter one is out of sight when it is over.
    short = {
        name: value[:20] if value.shape[:1] == other["root_pos"].shape[:1] else value for name, value in other.items()
    }
    np.savez(file, **short)
    cut = extract(walked, ReplayWindow(None, None, beside=file))
    (line,) = [track for track in cut.tracks if (track.layer, track.name) == (LAYER, lines[0].name)]
    assert line.shown(10) and not line.shown(30)


def altered(path, **changed):
    with np.load(path) as held:
        found = {name: held[name] for name in held.files}
    for name, value in changed.items():
        found.pop(name, None)
        if value is not None:
            found[name] = value
    np.savez(path, **found)


def test_motions_of_other_trainers_are_read_and_broken_ones_are_not(walked, tmp_path, capsys):
    names = names_of(walked)
    write_motion(walked, tmp_path / "walk.npz")
    motion = read_motion(tmp_path / "walk.npz", names)
    with np.load(tmp_path / "walk.npz") as held:
        amp = {
            "fps": np.int64(50), "dof_names": held["joint_names"], "body_names": held["body_names"],
            "dof_positions": held["joint_pos"], "body_positions": held["body_pos_w"],
            "body_rotations": held["body_quat_w"],
        }  # fmt: skip
        plain = {name: held[name] for name in ("fps", "joint_pos", "joint_vel", "body_pos_w", "body_quat_w")}
    for name, table in {"amp": amp, "plain": plain}.items():
        np.savez(tmp_path / f"{name}.npz", **table)
        other = read_motion(tmp_path / f"{name}.npz", names)
        np.testing.assert_array_equal(
            other.configurations(names, np.zeros(len(names))), motion.configurations(names, np.zeros(len(names)))
        )
    broken = {
        "joint 'elsewhere'": {"joint_names": np.array(["elsewhere", *names[1:]])},
        "not finite": {"joint_pos": np.full_like(plain["joint_pos"], np.nan)},
        "no rotations": {"root_quat": np.full((len(motion), 4), 0.9)},
        "not of one number of frames": {"root_pos": np.zeros((3, 3))},
        "are named or the robot's": {"joint_names": np.array(names[:5])},
        "no layout that is known": {"joint_pos": None},
    }
    for said, changed in broken.items():
        write_motion(walked, tmp_path / "broken.npz", replace=True)
        altered(tmp_path / "broken.npz", **changed)
        with pytest.raises(LogError, match=said):
            read_motion(tmp_path / "broken.npz", names)
    (tmp_path / "text.npz").write_text("no archive")
    (tmp_path / "few.csv").write_text("1,2,3\n")
    for file, said in {
        "text.npz": "no motion",
        "few.csv": "3 columns",
        "none.csv": "no motion",
        "w.pkl": "unknown",
    }.items():
        out = tmp_path / "page.html"
        assert main(["replay", str(walked.path), "--html", str(out), "--beside", str(tmp_path / file)]) == 2
        told = capsys.readouterr().err
        assert said in told and told.count("\n") == 1 and not out.exists()
