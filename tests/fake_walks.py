"""A robot, robots and a closed loop that need neither engine: the log is filled with motion of known metrics."""

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

import surefoot
from surefoot.models.facts import RobotFacts
from surefoot.scenarios.file.schema import RobotSettings, Scenario
from surefoot.scenarios.log import LogWriter
from surefoot.scenarios.many import slots
from surefoot.scenarios.record import channels
from surefoot.scenarios.run.skeleton import End, Progress
from surefoot.scenarios.show.differences import WALL_CLOCK

JOINTS = ("left_hip", "left_knee", "right_hip", "right_knee")
SIZES = channels.Sizes(nj=4, nq=11, nv=10, horizon=50)
CHANNELS = (
    *(channels.measurement, channels.truth, channels.estimate, channels.contact, channels.reference),
    channels.planner_state,
    *(channels.plan, channels.footstep, channels.wbc, channels.torque, channels.timing),
)
FOOT = 0.075
Changes = Mapping[tuple[str, int], Callable[[float, Any], Any]]


ZEROS, AHEAD = np.zeros(18), np.array([0.001, 0.0, 0.0])
MEASURED = np.array([0.1, 0.3, 0.1, -0.5]), np.full(4, 0.5), np.full(4, -10.0)
TORQUE = np.array([30.0, -40.0, 5.0, 0.0])
COP = 0.4 * FOOT / 2 * np.array([0.5, -1.0])
CORNERS = np.array([[-1, -1], [1, -1], [1, 1], *5 * [[-1, 1]]])
ONE_SOLE, TWO_SOLES = (CORNERS * [FOOT / 2, FOOT / 2 + beside] for beside in (0.0, 0.125))
"""Corners of the support about its middle, the last one repeated [m]."""


class FakeRobots:
    def names(self) -> tuple[str, ...]:
        return ("humanoid100", "talos")

    def facts(self, name: str, options: RobotSettings) -> RobotFacts:
        width = options.foot_width or FOOT
        return RobotFacts(
            bodies=("pelvis", "torso"), leg_length=0.92, hip_width=0.2, com_above_hip=0.114,
            foot_length=options.foot_length or FOOT, foot_width=width, shank_spacing=0.11,
            swing_acceleration=(60.0, 50.0),
        )  # fmt: skip

    def one_foot_share(self, name: str, options: RobotSettings) -> float:
        return 0.4


@dataclass
class Motion:
    """The motion that the fake loop writes; the defaults meet the default criteria of a scenario of two steps.

    Each half second: stand, step on the left foot, step on the right foot, stand. The soles turn from the first yaw by
    the second over the run; the pause holds the CoM on both feet from 1 s on. The margins of the plans are told, untold
    (NaN) or absent, as before there were any; a fall is known 0.2 s before. Fields may be changed, by topic and number
    of the field: each by a function of the time [s] and of the value.
    """

    duration: float = 4.0
    rate: int = 500
    speed: float = 0.4
    zmp_offset: tuple[float, float] = (0.003, -0.004)
    plan_offset: tuple[float, float, float] = (0.001, 0.002, 0.003)
    yaw: tuple[float, float] = (0.0, 0.0)
    pause: float = 0.0
    fall_at: float = np.inf
    margins: str = "told"
    stop_at: float = np.inf
    end: End | None = None
    raises: BaseException | None = None
    changes: Changes | None = None

    def __call__(self, walk: Any, writer: LogWriter, on_progress: Callable[[Progress], None]) -> End:
        _Loop(self, writer).run(on_progress)
        if self.raises is not None:
            raise self.raises
        if self.end is not None:
            return self.end
        fell = self.fall_at < self.duration
        return End("fall", self.fall_at, "the robot fell") if fell else End("completed", self.duration)


class _Changed:
    """A channel some of whose fields are changed before they are written."""

    def __init__(self, channel: Any, changes: Mapping[int, Callable[[float, Any], Any]]) -> None:
        self._channel, self._changes = channel, changes

    def append(self, ns: int, *values: Any) -> None:
        changed = list(values)
        for index, change in self._changes.items():
            changed[index] = change(ns * 1e-9, np.array(values[index], float))
        self._channel.append(ns, *changed)


class _Loop:
    def __init__(self, motion: Motion, writer: LogWriter) -> None:
        self.motion = motion
        specs = {make.__name__: make(SIZES) for make in CHANNELS}
        if motion.margins == "absent":
            specs["plan"] = replace(specs["plan"], fields=specs["plan"].fields[:-4])
        self.out: dict[str, Any] = {}
        for name, spec in specs.items():
            changes = {index: of for (topic, index), of in (motion.changes or {}).items() if topic == spec.topic}
            channel = writer.channel(spec)
            self.out[name] = _Changed(channel, changes) if changes else channel

    def run(self, on_progress: Callable[[Progress], None]) -> None:
        motion = self.motion
        for tick in range(round(motion.duration * motion.rate)):
            time = tick / motion.rate
            if time >= motion.stop_at:
                return
            self.tick(time, tick * 10**9 // motion.rate)
            if tick % (motion.rate // 50) == 0:
                self.plan(time, tick * 10**9 // motion.rate)
                on_progress(Progress(time, motion.duration, "standing", 3.0))
            if time in (1.0, 1.5):
                error = 0.006 if time == 1.0 else 0.002
                index = int(time * 2) - 1
                sole = np.array([self.com(time)[0], 0.125, 0.0, 0.0])
                ns = tick * 10**9 // motion.rate
                self.out["footstep"].append(ns, index, 0, sole - (error, 0.0, 0.0, 0.0), sole)

    def com(self, time: Any) -> Any:
        moved = self.motion.speed * (np.clip(time, 0.5, 1.5) - 0.5)
        height = np.where(np.asarray(time) >= self.motion.fall_at, 0.3, 1.0)
        return np.stack(np.broadcast_arrays(moved, 0.0, height), axis=-1)

    def tick(self, time: float, ns: int) -> None:
        single = 0.5 <= time < 1.5
        stance = (0 if time < 1.0 else 1) if single else -1
        moved = self.motion.speed * (min(max(time, 0.5), 1.5) - 0.5)
        com = np.array([moved, 0.0, 0.3 if time >= self.motion.fall_at else 1.0])
        paused = 1.0 <= time < 1.0 + self.motion.pause
        velocity = np.array([self.motion.speed if single and not paused else 0.0, 0.0, 0.0])
        yaw = self.motion.yaw[0] + self.motion.yaw[1] * time / self.motion.duration
        facing = (0.0, 0.0, math.sin(0.5 * yaw), math.cos(0.5 * yaw))
        soles = [np.array([moved, y, 0, *facing]) for y in (0.125, -0.125)]
        loaded = [paused or stance in (-1, 0), paused or stance in (-1, 1)]
        center = np.array([moved, {-1: 0.0, 0: 0.125, 1: -0.125}[stance]])
        support = center + (TWO_SOLES if stance == -1 else ONE_SOLE)
        out = self.out
        zero3, zero6 = ZEROS[:3], ZEROS[:6]
        out["measurement"].append(ns, *MEASURED, zero3, zero3, zero6, zero6, zero3)
        out["truth"].append(ns, ZEROS[:11], ZEROS[:10], com, velocity, zero3, *soles, 0.01, 0, 0)
        out["estimate"].append(ns, com + AHEAD, velocity, com[:2], zero3, zero6, zero3, zero3, 100.0)
        off_x, off_y = self.motion.zmp_offset
        zmp = np.array([center[0] + off_x, center[1] + off_y, 0.0])
        out["contact"].append(ns, zmp, [490.0 * one for one in loaded], loaded, loaded, loaded, COP, COP, (0, 0))
        out["reference"].append(
            ns,
            *(com, velocity, zero3, center, com[:2], 3.13, center, zero3, zero3),
            *(2 if single else 0, stance, 0, 0.0, 0.5, support, 4, ZEROS[:2]),
        )
        out["wbc"].append(ns, 0, 0, 5, 0, 1e-9, 1e-9, ZEROS[:10], zero6, zero6, ZEROS)
        out["torque"].append(ns, TORQUE, 0.4)
        out["timing"].append(ns, 10, 80, 60, 200 if ns % 20_000_000 == 0 else 0, 30, 10, 500, 2100 if ns == 0 else 300)

    def plan(self, time: float, ns: int) -> None:
        times = time + 0.02 * np.arange(51)
        com = self.com(times) - np.array(self.motion.plan_offset)
        velocity = np.zeros((51, 3))
        velocity[:, 0] = np.where((times >= 0.5 - 1e-9) & (times < 1.5 - 1e-9), self.motion.speed, 0.0)
        status, balance = (0, [0, 0], 0, 0), ([0.05, 0.3 - 0.1 * time], [0.003, -0.004], -0.02)
        if self.motion.margins == "untold":
            balance = [np.nan] * 2, [np.nan] * 2, np.nan
        told = () if self.motion.margins == "absent" else (*balance, time >= self.motion.fall_at - 0.2)
        flat = np.zeros((51, 2))
        given = (self.com(time) + np.array([0.001, 0.0, 0.0]), velocity[0])
        self.out["planner_state"].append(ns, *given, np.zeros(2), *given, np.zeros(2), np.zeros(2))
        self.out["plan"].append(ns, com, velocity, flat, flat, np.zeros((50, 2)), np.full(51, 3.13), *status, *told)


@pytest.fixture
def robots() -> FakeRobots:
    return FakeRobots()


@pytest.fixture(scope="session")
def robot() -> SimpleNamespace:
    return SimpleNamespace(
        name="stand-in",
        mjcf="<mujoco/>",
        leg_length=0.94,
        mass=100.0,
        sole_length=FOOT,
        sole_width=FOOT,
        shank_spacing=0.11,
        joint_names=JOINTS,
        joint_indices=lambda names: tuple(map(JOINTS.index, names)),
        straight_joint_positions=np.zeros(4),
        roles=SimpleNamespace(knees=JOINTS[1::2], left_leg=JOINTS[:2], right_leg=JOINTS[2:]),
        torso_body="torso",
        torque_limit=np.full(4, 100.0),
        velocity_limit=np.full(4, 10.0),
        position_lower=np.full(4, -0.6),
        position_upper=np.full(4, 2.0),
        left_out=(),
        couplings=(),
    )


@pytest.fixture(scope="session")
def motion() -> type[Motion]:
    return Motion


@pytest.fixture(scope="session")
def two_steps() -> Scenario:
    return Scenario(name="two-steps", gait={"steps": 2})


def _same_content(a: str | Path, b: str | Path) -> list[str]:
    """Topics in which two logs differ, wall-clock times aside."""
    first, second = surefoot.read(a), surefoot.read(b)
    assert first.topics == second.topics
    topics = [topic for topic in first.numeric if topic not in WALL_CLOCK]
    return [topic for topic in topics if first[topic].content() != second[topic].content()]


@pytest.fixture(name="same_content")
def same_content_fixture() -> Callable[..., list[str]]:
    return _same_content


def alone(patch, module):
    """Let a module do in this process what it does in processes side by side; `patch` takes it back."""
    patch.setattr(module, "side_by_side", lambda work, given, *_: (work(*one) for one in given))


def with_worker(patch, worker):
    """Let a class of a worker, of a folder and whether it keeps all logs, make the runs of campaigns and checks."""
    patch.setattr(slots, "local_workers", lambda folder, jobs, keep_all: [worker(folder, keep_all)])
