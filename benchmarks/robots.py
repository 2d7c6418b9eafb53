"""A benchmark of public humanoids: read, derived, stood, walked, turned and pushed.

    python benchmarks/robots.py [FOLDER]... [--only NAME]... [--jobs N] [--out DIR] [--csv FILE] [--against FILE]

Some models come with packages, which pip installs; the others are looked for in the folders, which may be clones of
their repositories. A robot file is drafted from each model as `surefoot robot new` does it, and the lines that somebody
had to add are counted. Then it stands, walks, turns, and is pushed in the middle of a step from four sides. Where
`walk` is refused with a gait that the robot can walk, it walks that one. With `--against` the rows are held against a
table of before, and the exit code is 1 where one has moved.
"""

import argparse
import csv
import re
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import yaml

from surefoot.apps.robots.draft import draft
from surefoot.apps.robots.examine import examine, known
from surefoot.models.types import RobotError
from surefoot.scenarios.errors import LogError, ScenarioError, SetupError
from surefoot.scenarios.output import write_whole
from surefoot.scenarios.record.provenance import relevant_versions
from surefoot.scenarios.run.processes import cores, side_by_side
from surefoot.scenarios.run.run import run_scenario
from surefoot.scenarios.setup.load import load

IMPULSE = 0.1
"""Impulse of each push, over the robot's mass [N s/kg]."""

SIDES = (0, 90, 180, 270)
"""Directions that pushes go to, from the way it walks to the left [deg]."""

PUSHED = {"gait.steps": "9", "criteria": "{fell: false, steps_taken: steps_planned}"}
"""Settings of the walk that is pushed in its fifth step."""

DATA = "package://example-robot-data/robots"
FOURIER = "package://fourier_robot_descriptions/assets/urdf"


PROPOSAL = re.compile(r"take for example ([^;(]+)")
SETTING = re.compile(r"--set '?(\w+\.\w+)=(-?[\d.]+|\[[^\]]*\])")
"""Proposal of a refusal, with a key and its value."""


@dataclass(frozen=True, slots=True)
class Model:
    """A model of a humanoid.

    Attributes:
        name: of the robot.
        place: ``package://`` of an installed package, or the end of a path in one of the folders.
        source: package or repository.
        added: lines of the robot file that `surefoot robot new` does not write.
    """

    name: str
    place: str
    source: str
    added: tuple[str, ...] = ()


MODELS = (
    Model("TALOS", f"{DATA}/talos_data/robots/talos_full_v2.urdf", "example-robot-data"),
    Model("G1", f"{DATA}/g1_description/urdf/g1_29dof_rev_1_0.urdf", "example-robot-data"),
    Model("Alexander", f"{DATA}/alexander_description/urdf/alexander_v1.lowerBodyOnly.urdf", "example-robot-data"),
    Model("Romeo", f"{DATA}/romeo_description/urdf/romeo.urdf", "example-robot-data"),
    Model("iCub", f"{DATA}/icub_description/robots/icub.urdf", "example-robot-data"),
    Model(
        "simple humanoid",
        f"{DATA}/simple_humanoid_description/urdf/simple_humanoid.urdf",
        "example-robot-data",
        ("sole: {length: 0.22, width: 0.11, centre: [0.04, 0.0, -0.07]}",),
    ),
    Model("JVRC-1", "package://jvrc_description/urdf/jvrc1.urdf", "jvrc-description"),
    Model("GR-1", f"{FOURIER}/gr1t1.urdf", "fourier-robot-descriptions"),
    Model("GR-1 T2", f"{FOURIER}/gr1t2.urdf", "fourier-robot-descriptions"),
    Model("GR-2", f"{FOURIER}/gr2t2.urdf", "fourier-robot-descriptions"),
    Model("GR-3", f"{FOURIER}/gr3.urdf", "fourier-robot-descriptions"),
    Model("QingLong", f"{FOURIER}/qinglong.urdf", "fourier-robot-descriptions"),
    Model("G1 (MJCF)", "g1_description/g1_29dof_rev_1_0.xml", "unitreerobotics/unitree_ros"),
    Model("H1", "h1_description/urdf/h1.urdf", "unitreerobotics/unitree_ros"),
    Model("H1_2", "h1_2_description/h1_2.urdf", "unitreerobotics/unitree_ros"),
    Model("H1_2 (MJCF)", "h1_2_description/h1_2.xml", "unitreerobotics/unitree_ros"),
    Model("R1", "unitree_robots/r1/R1_C++.xml", "unitreerobotics/unitree_mujoco"),
    Model("T1", "robots/T1/T1_23dof.urdf", "BoosterRobotics/booster_assets"),
    Model("T1 (MJCF)", "robots/T1/T1_23dof.xml", "BoosterRobotics/booster_assets"),
    Model("T1 (serial)", "resources/T1/T1_serial.urdf", "BoosterRobotics/booster_gym"),
    Model("K1", "robots/K1/K1_22dof.urdf", "BoosterRobotics/booster_assets"),
    Model("Atlas", "atlas/atlas_minimal_contact.urdf", "RobotLocomotion/models"),
    Model("Valkyrie", "val_description/model/robots/valkyrie_A.urdf", "gkjohnson/nasa-urdf-robots"),
    Model("iCub 2.5", "iCub/robots/iCubGazeboV2_5/model.urdf", "robotology/icub-models"),
    Model("ergoCub", "ergoCub/robots/ergoCubSN000/model.urdf", "icub-tech-iit/ergocub-software"),
    Model("X1", "robots/x1/urdf/x1.urdf", "AgibotTech/agibot_x1_train"),
    Model("SA01", "zq_humanoid/urdf/zq_sa01.urdf", "engineai-robotics/engineai_legged_gym"),
    Model("Pai", "pai_12dof/urdf/pai_12dof.urdf", "HighTorque-Robotics/livelybot_pi_rl_baseline"),
    Model("AzureLoong", "models/AzureLoong.urdf", "loongOpen/OpenLoong-Dyn-Control"),
    Model("XBot-L", "XBot/urdf/XBot-L.urdf", "roboterax/humanoid-gym"),
    Model("NAO", "naoV50_generated_urdf/nao.urdf", "ros-naoqi/nao_robot"),
    Model("TOCABI", "robots/dyros_tocabi.urdf", "saga0619/dyros_tocabi_v2"),
    Model("DeepMimic's humanoid", "assets/humanoid/humanoid.xml", "xbpeng/MimicKit", ("lock: ['*_ankle_z']",)),
    Model("MuJoCo's humanoid", "model/humanoid/humanoid.xml", "google-deepmind/mujoco", ("com_height: 0.82",)),
    Model("dm_control's humanoid", "dm_control/suite/humanoid.xml", "google-deepmind/dm_control"),
)


@dataclass(frozen=True, slots=True)
class Row:
    """The results of a robot.

    Attributes:
        model: that it was made of.
        reads, derives, stands, walks, turns: whether it did; None where it did not come so far.
        pushed: sides from which a push was survived with all steps taken; None where it was not pushed.
        gait: settings over `walk` that a refusal proposed and that were walked instead.
        missed: criteria of `walk` that were missed, or with other settings of that gait.
        mass: of the robot [kg].
        joints: that it has.
        why: what kept it from more, one sentence each.
    """

    model: Model
    reads: bool = False
    derives: bool | None = None
    stands: bool | None = None
    walks: bool | None = None
    turns: bool | None = None
    pushed: int | None = None
    gait: tuple[str, ...] = ()
    missed: tuple[str, ...] = ()
    mass: float = 0.0
    joints: int = 0
    why: tuple[str, ...] = ()

    @property
    def good(self) -> bool:
        """True if it takes all steps and survives every push with at most two lines added."""
        return bool(self.walks) and self.pushed == len(SIDES) and len(self.model.added) <= 2


def found(model: Model, folders: Sequence[Path]) -> str | None:
    """Name by which a robot file may call the model; None where no folder has it."""
    if model.place.startswith("package://"):
        return model.place
    name = Path(model.place).name
    here = (path for folder in folders for path in sorted(folder.rglob(name)) if path.as_posix().endswith(model.place))
    return next((str(path.absolute()) for path in here), None)


def examined(model: Model, place: str, out: Path) -> Row:
    """Everything of one robot."""
    row = Row(model)
    try:
        made = draft(place, Path())
        row = replace(row, reads=True, derives=False)
        file = out / "files" / f"{''.join(sign for sign in model.name if sign.isalnum())}.yaml"
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(with_lines(made.text, model.added), encoding="utf-8")
        robot = known(str(file)).description
        row = replace(row, derives=True, mass=robot.mass, joints=len(robot.joint_names))
        faults = examine(robot).faults
    except (RobotError, ScenarioError) as refusal:
        return replace(row, why=(" ".join(str(refusal).split()),))
    except Exception as error:  # a fault of ours, which ends no table
        return replace(row, why=(f"{type(error).__name__}: {' '.join(str(error).split())}",))
    return _moved(replace(row, why=faults), {"robot": str(file)}, out)


def with_lines(text: str, added: Iterable[str]) -> str:
    """A robot file with lines in place of those of the same keys."""
    keys = {key for line in added for key in yaml.safe_load(line)}
    kept = [line for line in text.splitlines() if line.partition(":")[0] not in keys]
    return "\n".join([*kept, *added, ""])


def _moved(row: Row, robot: Mapping[str, str], out: Path) -> Row:
    """The row with what it did; where `walk` is refused, all is done with the gait that the refusal proposes."""
    stood = _run("stand", robot, out)
    walked, gait = followed("walk-level", robot, out)
    settings = tuple(f"{key}={value}" for key, value in gait.items())
    row = replace(row, stands=stood.stayed, walks=walked.stayed, gait=settings, missed=walked.missed)
    if not walked.stayed:
        return replace(row, why=(*row.why, *stood.refused, *walked.refused))
    turned, _ = followed("walk-turn", robot, out)
    survived, why = 0, [*row.why, *turned.refused]
    for side in SIDES:
        push = f"[{{step: 5, phase: single, fraction: 0.5, impulse: {IMPULSE}, direction: {side} deg}}]"
        pushed = _run("walk-level", {**robot, **gait, **PUSHED, "pushes": push}, out)
        survived += pushed.stayed
        why += pushed.refused
    return replace(row, turns=turned.stayed, pushed=survived, why=tuple(dict.fromkeys(why)))


@dataclass(frozen=True, slots=True)
class Walked:
    """A run.

    Attributes:
        stayed: whether it took all its steps and did not fall.
        missed: criteria that were missed.
        refused: why there was no run, one sentence each.
    """

    stayed: bool = False
    missed: tuple[str, ...] = ()
    refused: tuple[str, ...] = ()


def _run(name: str, settings: Mapping[str, str], out: Path) -> Walked:
    try:
        result = run_scenario(
            load(name, ["sensing.source=truth", *(f"{key}={value}" for key, value in settings.items())]), out / "logs"
        )
    except (ScenarioError, SetupError, LogError) as refusal:
        return Walked(refused=tuple(str(refusal).splitlines()))
    metrics = result.verdict.metrics
    stayed = not metrics["fell"] and metrics["steps_taken"] == metrics["steps_planned"]
    return Walked(stayed, tuple(result.verdict.reasons))


Run = Callable[[str, Mapping[str, str], Path], Walked]
"""Runs a scenario with settings, and keeps its log in a folder."""


def followed(name: str, robot: Mapping[str, str], out: Path, run: Run = _run) -> tuple[Walked, dict[str, str]]:
    """A run, or if it is refused that with what the refusals propose, and these settings."""
    settings: dict[str, str] = {}
    while True:
        walked = run(name, {**robot, **settings}, out)
        proposed = dict(SETTING.findall(" ".join(PROPOSAL.findall(" ".join(walked.refused)))))
        if not proposed.keys() - settings.keys():
            return walked, settings
        settings |= proposed


def _lost(model: Model, place: str, out: Path, why: str) -> Row:
    return Row(model, why=(why,))


HEADINGS = (
    *("robot", "source", "kg", "joints", "reads", "derives", "stands", "walks", "turns"),
    *("pushed", "criteria missed", "lines added"),
)


def cells(row: Row) -> tuple[str, ...]:
    """A row in words."""
    marks = {True: "yes", False: "**no**", None: "–"}
    did = (marks[value] for value in (row.reads, row.derives, row.stands, row.walks, row.turns))
    pushed = "–" if row.pushed is None else f"{row.pushed} of {len(SIDES)}"
    size = (f"{row.mass:.0f}", str(row.joints)) if row.derives else ("–", "–")
    missed = str(len(row.missed)) if row.walks is not None else "–"
    return (row.model.name, row.model.source, *size, *did, pushed, missed, str(len(row.model.added)))


def table(rows: Sequence[Row]) -> str:
    """All of it as Markdown: the table, then what is to be said of rows."""
    lines = [_line(HEADINGS), _line("---" for _ in HEADINGS), *(_line(cells(row)) for row in rows), ""]
    lines += [f"- {row.model.name}: {remark}" for row in rows for remark in _remarks(row)]
    good = sum(row.good for row in rows)
    return "\n".join([*lines, "", f"{good} of {len(rows)} take all steps and survive every push.", ""])


def moved_from(rows: Sequence[Row], path: Path) -> Iterator[str]:
    """Differences from a kept table, one sentence each."""
    lines = [line for line in path.read_text(encoding="utf-8").splitlines() if not line.startswith("#")]
    before = {was["robot"]: was for was in csv.DictReader(lines)}
    for row in rows:
        was, now = before.get(row.model.name), dict(zip(HEADINGS, cells(row), strict=True))
        if was is None:
            yield f"{row.model.name}: not in {path}"
            continue
        for heading in HEADINGS:
            if was[heading] != now[heading]:
                yield f"{row.model.name}: {heading} was {was[heading]}, is {now[heading]}"


def write(rows: Sequence[Row], path: Path) -> None:
    """The table as docs/results keeps it: by what it was made, and its rows."""
    code = relevant_versions()
    with write_whole(path, replace=True) as temporary, temporary.open("w", newline="", encoding="utf-8") as file:
        file.write("# python benchmarks/robots.py FOLDER...\n")
        file.write(f"# surefoot {code['surefoot']}, source_digest {code['source_digest']}\n")
        csv.writer(file, lineterminator="\n").writerows([HEADINGS, *map(cells, rows)])


def _line(cells: Iterable[str]) -> str:
    return f"| {' | '.join(cells)} |"


def _remarks(row: Row) -> Iterator[str]:
    if row.gait:
        yield f"walks with `{' '.join(row.gait)}`"
    yield from (f"added `{line}`" for line in row.model.added)
    yield from (f"missed: {reason}" for reason in row.missed)
    yield from row.why


def main(arguments: Sequence[str] | None = None, models: Sequence[Model] = MODELS) -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folders", nargs="*", type=Path, metavar="FOLDER", help="with models that no package brings")
    parser.add_argument("--only", action="append", metavar="NAME", help="of the robots this one alone; repeatable")
    parser.add_argument("--jobs", type=int, default=cores(), help="robots at once")
    parser.add_argument("--out", type=Path, default=Path("runs/robots"), help="directory of robot files and logs")
    parser.add_argument("--csv", type=Path, help="also write the table to this file, as docs/results keeps it")
    parser.add_argument("--against", type=Path, metavar="FILE", help="a table of before, as --csv writes it")
    given = parser.parse_args(arguments)
    chosen = [model for model in models if not given.only or model.name in given.only]
    places = {model.name: found(model, given.folders) for model in chosen}
    for name in (name for name, place in places.items() if place is None):
        print(f"{name}: in none of the folders")
    tasks = [(model, place, given.out) for model in chosen if (place := places[model.name]) is not None]
    if not tasks:
        raise SystemExit("no robot: install the extra robots, or give folders with models")
    rows = {}
    for row in side_by_side(examined, tasks, given.jobs, _lost):
        rows[row.model.name] = row
        print(" ".join(cells(row)), *(f"\n  - {remark}" for remark in _remarks(row)), flush=True)
    done = [rows[model.name] for model, *_ in tasks]
    print(table(done))
    moved = [] if given.against is None else list(moved_from(done, given.against))
    if given.csv is not None:
        write(done, given.csv)
    if given.against is not None:
        print("\n".join(moved) or f"as in {given.against}")
        raise SystemExit(1 if moved else 0)


if __name__ == "__main__":
    main()
