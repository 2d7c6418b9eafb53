"""The constants of a run that its log carries beside the channels, and the versions of all that it depends on."""

import hashlib
import itertools
import json
import math
import platform
import re
import subprocess
from collections.abc import Iterator, Mapping
from dataclasses import asdict, dataclass, field, fields, replace
from functools import cache
from importlib.metadata import PackageNotFoundError, distribution
from pathlib import Path
from types import MappingProxyType

from pydantic import TypeAdapter

from surefoot.forces import Push
from surefoot.native import modules
from surefoot.scenarios.errors import LogError
from surefoot.similarity import Similarity

RECORD = "run"
"""Name of the metadata record."""

WORLD_FILE = "world.xml"
"""Attachment that holds the simulated world as MJCF, the robot in it."""

SCENARIO_FILE = "scenario.yaml"
"""Attachment that holds the scenario as run."""

END_RECORD = "end"
"""Metadata record written last: how the run ended."""

STOPPED = "stopped from outside"
"""Reason of the end of a run that a program or a driver has closed: it is as long as they wanted it."""

AFTER_FALL = 0.3
"""Time for which a run goes on after a fall, so that the log shows it [s]."""

PUSH_RECORD = "push "
"""Beginning of the names of metadata records that hold a push given while the run went on, each with its number."""

BEGUN_RECORD = "begun "
"""Beginning of the names of those that hold a push which waited for a point of the gait, as it began."""

COMMAND_RECORD = "command "
"""Beginning of the names of those that hold a command, in the words of a scenario's `commands`."""

AGENDA_RECORD = "agenda"
"""Metadata record of what was to happen in a run, and when; logs of earlier versions have none."""

SEAT_RECORD = "controller"
"""Metadata record of what has the seat of planner and whole-body controller: its name and its parameters, as JSON."""

PARTS_RECORD = "parts"
"""Metadata record of what a user's program put in place of a part, which a log cannot carry."""

LOG_NAME, VERDICT_NAME = "log.mcap", "verdict.json"
"""Files of a run in its folder."""


def run_folders(out: Path, scenario: str, seed: int) -> Iterator[Path]:
    """Folders that a run may have for its own, in order: the first that nobody has taken."""
    yield out / f"{scenario}-{seed}"
    yield from (out / f"{scenario}-{seed}-{number}" for number in itertools.count(2))


_GREATEST = 1e6
"""No mass, size or rate of a run is greater."""


@dataclass(frozen=True, slots=True)
class RunConstants:
    """The constants of a run.

    Attributes:
        scenario: its name.
        fidelity: full or pendulum.
        seed: its seed.
        steps_planned: footsteps asked for.
        mass: true mass of the robot [kg].
        com_height: true nominal CoM height above the soles [m].
        foot_length: of the soles [m].
        foot_width: of the soles [m].
        control_rate: ticks of the controller [Hz].
        sample_time: of the planner's preview [s].
        joint_names: in the order of the joint arrays.
        torque_limit: by joint [N m].
        position_lower: by joint [rad].
        position_upper: by joint [rad].
        terrain: kind of ground.
        plant: of fidelity pendulum.
        boxes: the solids on the ground plane, each as centre, half sizes [m] and rotation to the world, row by row.
        roles: names of joints and bodies by role (knees, left_leg, right_leg, torso); a log may lack them.
        velocity_limit: no-load speed by joint; empty in a log that lacks them [rad/s].
        plane: height of the ground plane; a log has it where it is not 0 [m].
        knee_straight: angles of the knees at which the legs are straight; a log has it where they are not 0 [rad].
        knee_turn: turn of the shanks for an angle of the knees; a log has it where that is not 1 [-].
        unforeseen: numbers of the boxes that are not where planner and controller believe them to be, by the key of the
            scenario that has put them there; a log has it where there are any.
        waypoints: places to go to one after another, as x, y [m] and heading [rad] in the world; a log has
            it where there are any.
        size: length and mass of the robot over the reference's; a log has it where they are not 1 [-].
        controller: name of what has the seat of planner and whole-body controller; a log has it where something has.
    """

    scenario: str
    fidelity: str
    seed: int
    steps_planned: int
    mass: float
    com_height: float
    foot_length: float
    foot_width: float
    control_rate: int
    sample_time: float
    joint_names: tuple[str, ...]
    torque_limit: tuple[float, ...]
    position_lower: tuple[float, ...]
    position_upper: tuple[float, ...]
    terrain: str
    plant: str = "pendulum"
    boxes: tuple[tuple[float, ...], ...] = ()
    roles: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    velocity_limit: tuple[float, ...] = ()
    plane: float = 0.0
    size: tuple[float, float] = (1.0, 1.0)
    knee_straight: tuple[float, ...] = ()
    knee_turn: tuple[float, ...] = ()
    unforeseen: Mapping[str, tuple[int, ...]] = field(default_factory=dict)
    waypoints: tuple[tuple[float, float, float], ...] = ()
    controller: str = ""

    @property
    def walker(self) -> str:
        """Kind of what walks: full, pendulum, or seat, of a robot whose controller is none of Surefoot's own."""
        return "seat" if self.controller else self.fidelity

    @property
    def similarity(self) -> Similarity:
        """The robot's size, with which thresholds of what judges the run go."""
        return Similarity(*self.size)

    def to_metadata(self) -> dict[str, str]:
        """Write as metadata: JSON by name."""
        written = {entry.name: getattr(self, entry.name) for entry in fields(self)}
        if self.plane == 0.0:
            del written["plane"]
        if self.size == (1.0, 1.0):
            del written["size"]
        for name in ("knee_straight", "knee_turn", "unforeseen", "waypoints", "controller"):
            if not written[name]:
                del written[name]
        return {name: json.dumps(value) for name, value in written.items()}

    @classmethod
    @cache
    def _adapter(cls) -> "TypeAdapter[RunConstants]":
        """Reads one back; made once, which takes longer than all that it reads."""
        return TypeAdapter(cls)

    @classmethod
    def from_metadata(cls, records: Mapping[str, Mapping[str, str]], log_name: str) -> "RunConstants":
        """Read back.

        Args:
            records: the metadata of a log.
            log_name: what to call the log in messages.

        Raises:
            LogError: the log does not carry them.
        """
        try:
            values = {name: json.loads(text) for name, text in records[RECORD].items()}
            found = cls._adapter().validate_python(values)
        except (KeyError, TypeError, ValueError, OverflowError, RecursionError):
            raise LogError(f"{log_name}: does not describe a run; give a log that `surefoot run` has written") from None
        if wrong := found._impossible():
            raise LogError(f"{log_name}: its run has an impossible {wrong}; give a log that `surefoot run` has written")
        return found

    def _impossible(self) -> str:
        """The first constant that no run can have, with its value; empty if there is none."""
        sizes = ("mass", "com_height", "foot_length", "foot_width", "control_rate", "sample_time")
        for name in sizes:
            if not 0.0 < getattr(self, name) < _GREATEST:
                return f"{name}, {getattr(self, name)}"
        if not all(0.0 < part < _GREATEST for part in self.size):
            return f"size, {self.size}"
        for name in ("knee_straight", "knee_turn"):
            if len(getattr(self, name)) not in (0, len(self.roles.get("knees", ()))):
                return f"{name}, {getattr(self, name)}"
        if self.steps_planned < 0 or self.fidelity not in ("full", "pendulum"):
            return f"number of steps or fidelity, {self.steps_planned}, {self.fidelity}"
        for name in ("torque_limit", "position_lower", "position_upper"):
            values = getattr(self, name)
            if len(values) != len(self.joint_names) or any(math.isnan(value) for value in values):
                return f"{name}, of {len(values)} numbers for {len(self.joint_names)} joints"
        boxes_fit = all(len(box) == 15 and all(map(math.isfinite, box)) for box in self.boxes)
        numbers = [number for found in self.unforeseen.values() for number in found]
        numbered = all(0 <= number < len(self.boxes) for number in numbers)
        if not (boxes_fit and numbered and math.isfinite(self.plane)):
            return "ground"
        if not all(map(math.isfinite, (part for place in self.waypoints for part in place))):
            return "waypoint"
        return ""


@dataclass(frozen=True, slots=True)
class Event:
    """A push or a fault that a run shall have, on its clock.

    Attributes:
        what: words that go before its time, such as "pushes.0 begins at".
        time: at which it acts first [s].
        idle: why it does nothing though the run goes on until then; empty where it acts.
    """

    what: str
    time: float
    idle: str = ""

    def missed(self, end: float) -> str:
        """Reason why it does nothing in a run that ends at a time [s]; empty where it acts."""
        late = f"{self.what} {self.time:.6g} s and never acts: the run ends at {end:.6g} s"
        return late if self.time >= end else self.idle


@dataclass(frozen=True, slots=True)
class AskedPush:
    """A push that a plant was asked for, as a log tells it.

    Attributes:
        time: at which it begins [s].
        duration: how long it acts [s].
        force: world [N].
        body: that it acts on; empty for the point mass.
        live: whether it was given by hand, so that nothing was promised of it.
    """

    time: float
    duration: float
    force: tuple[float, float, float]
    body: str = ""
    live: bool = False

    @classmethod
    def of(cls, push: Push, live: bool = False) -> "AskedPush":
        """Make the promise of a push."""
        x, y, z = (float(part) for part in push.force)
        return cls(float(push.time), float(push.duration), (x, y, z), push.body, live)

    def to_metadata(self) -> dict[str, str]:
        """Write as the metadata of a record of its own: JSON."""
        return {"push": json.dumps(asdict(self))}


def asked_pushes(records: Mapping[str, Mapping[str, str]], log_name: str) -> tuple[AskedPush, ...]:
    """All pushes that a plant was asked for, in the order of their times; of an older log those given by hand.

    Args:
        records: the metadata of a log.
        log_name: what to call the log in messages.

    Raises:
        LogError: what the log tells of them cannot be read.
    """
    agenda = Agenda.from_metadata(records, log_name)
    promised = () if agenda is None else agenda.pushes
    begun = _pushes_of(records, BEGUN_RECORD, log_name)
    given = (replace(push, live=True) for push in _pushes_of(records, PUSH_RECORD, log_name))
    pushes = (*promised, *begun, *given)
    if not all(math.isfinite(part) for push in pushes for part in (push.time, push.duration, *push.force)):
        raise LogError(f"{log_name}: tells pushes that are not finite; give a log that `surefoot run` has written")
    return tuple(sorted(pushes, key=lambda push: push.time))


def _pushes_of(records: Mapping[str, Mapping[str, str]], kind: str, log_name: str) -> Iterator[AskedPush]:
    for name, record in records.items():
        if name.startswith(kind):
            try:
                yield TypeAdapter(AskedPush).validate_json(record["push"])
            except (KeyError, ValueError, RecursionError):
                what = f"its record '{name}' tells no push"
                raise LogError(f"{log_name}: {what}; give a log that `surefoot run` has written") from None


@dataclass(frozen=True, slots=True)
class Agenda:
    """The events of a scenario that only the setup of a run knows: their times, and keys that do nothing.

    Attributes:
        events: pushes and faults that are to act; pushes that were given by hand are not among them.
        pushes: that begin at a time, as the plant is asked for them.
        bodies: that the pushes act on, each once.
        notes: what else is to be known of the scenario, one sentence each.
        standing: those of the notes that hold only while nobody tells the robot by hand how to walk.
    """

    events: tuple[Event, ...] = ()
    bodies: tuple[str, ...] = ()
    notes: tuple[str, ...] = ()
    standing: tuple[str, ...] = ()
    pushes: tuple[AskedPush, ...] = ()

    def to_metadata(self) -> dict[str, str]:
        """Write as metadata: JSON by name."""
        return {name: json.dumps(value) for name, value in asdict(self).items()}

    @classmethod
    @cache
    def _adapter(cls) -> "TypeAdapter[Agenda]":
        """Reads one back; made once, which takes longer than all that it reads."""
        return TypeAdapter(cls)

    @classmethod
    def from_metadata(cls, records: Mapping[str, Mapping[str, str]], log_name: str) -> "Agenda | None":
        """Read back; None where the log has none.

        Raises:
            LogError: it cannot be read.
        """
        if AGENDA_RECORD not in records:
            return None
        try:
            values = {name: json.loads(text) for name, text in records[AGENDA_RECORD].items()}
            return cls._adapter().validate_python(values)
        except (ValueError, RecursionError):
            what = "does not say in words that can be read what was to happen in its run"
            raise LogError(f"{log_name}: {what}; give a log that `surefoot run` has written") from None


PACKAGES = ("surefoot", "mujoco", "pin", "proxsuite", "qpsolvers", "daqp", "piqp", "numpy", "scipy", "mcap")
CODE = ("planner", "wbc", "sim", "models", "scenarios", "studies", "apps", "native")
READERS = (
    "scenarios/check",
    "scenarios/many",
    "scenarios/show",
    "studies/paper",
    "studies/campaigns",
    "studies/incident",
)
"""Folders of the code, and those in it that only read logs: no run depends on them."""

_VERSION = re.compile(r"^Version: (\S+)$", re.MULTILINE)

ABSENT = "not installed"
"""Version of a package that is not there, as of a source tree that was never installed."""


def versions() -> dict[str, str]:
    """Versions of all that a result may depend on, by name, and the revision they are known by."""
    return {**relevant_versions(), "git_revision": _git_revision()}


@cache
def relevant_versions() -> Mapping[str, str]:
    """Versions of all that a result depends on: not the revision, which changes with a text too.

    Asked once: what has been loaded stays the same however long the process goes on.
    """
    found = {name: _version(name) for name in PACKAGES}
    found["python"] = platform.python_version()
    found["machine"] = f"{platform.system()} {platform.machine()}"
    found["native"] = modules.made() or "interpreted"
    found["source_digest"] = source_digest(Path(__file__).parents[2])
    return MappingProxyType(found)


def source_digest(root: Path) -> str:
    """Digest of the code that makes runs, as it is on the disk: tells apart what a revision with ``-dirty`` cannot.

    Args:
        root: folder that holds the code's folders.
    """
    digest = hashlib.sha256()
    shared = [path for path in root.iterdir() if root.name == "surefoot" and path.is_file()]
    code = (path for folder in CODE for path in (root / folder).rglob("*.[pch]*"))
    for path in sorted(path for path in (*shared, *code) if path.suffix in (".py", ".pxd", ".pyx", ".c", ".h")):
        name = path.relative_to(root).as_posix()
        if not name.startswith(READERS):
            digest.update(name.encode() + b"\0" + path.read_bytes() + b"\0")
    return digest.hexdigest()[:16]


def _version(package: str) -> str:
    try:
        found = distribution(package)
    except PackageNotFoundError:
        return ABSENT
    # Its first lines say it; what reads letters goes through the licences below, too, and takes ten times as long.
    matched = _VERSION.search(found.read_text("METADATA") or "")
    return matched[1] if matched else found.version


@cache
def _git_revision() -> str:
    """Commit of the source tree, with ``-dirty`` when it was changed; empty when it is not under git."""
    here = Path(__file__)
    tracked = git(here.parent, "ls-files", "--error-unmatch", here.name)
    return (git(here.parent, "describe", "--always", "--dirty", "--abbrev=40", "--exclude=*") or "") if tracked else ""


def git(folder: Path, *arguments: str) -> str | None:
    """Answer of git in a folder; None where it has none, as outside of a repository."""
    try:
        done = subprocess.run(["git", "-C", str(folder), *arguments], capture_output=True, text=True, timeout=10)
    except (OSError, subprocess.SubprocessError):
        return None
    return done.stdout.strip() if done.returncode == 0 else None
