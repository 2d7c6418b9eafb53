"""From the log of an incident to a scenario that shows it again, with no more causes than it takes."""

import math
import os
import re
import shutil
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import yaml

from surefoot.errors import PluginError
from surefoot.models.names import is_file
from surefoot.scenarios.errors import LogError, ScenarioError, SetupError
from surefoot.scenarios.file.schema import Scenario
from surefoot.scenarios.judge.digest import RunView
from surefoot.scenarios.judge.health import findings
from surefoot.scenarios.judge.loss import loss
from surefoot.scenarios.judge.metrics import digest
from surefoot.scenarios.log import Log, read
from surefoot.scenarios.output import write_whole
from surefoot.scenarios.record.provenance import PARTS_RECORD, relevant_versions
from surefoot.scenarios.run.run import run_scenario
from surefoot.scenarios.setup.events import due
from surefoot.scenarios.setup.load import attached_scenario, load, read_scenario
from surefoot.scenarios.setup.walk import Walk, resolve
from surefoot.scenarios.show.differences import VERSIONS_RECORD
from surefoot.studies.incident.causes import Cause, Values, causes_of, suspected, values_of, without
from surefoot.studies.incident.harm import Harm, Likeness, harm_of, likeness
from surefoot.studies.incident.smallest import smallest

AFTER = 2.0
"""Time after the fall of the log at which the scenario ends where it does not fall, of the reference robot [s]."""

BEFORE = 2.0
"""Time before a moment at which a scenario begins that is to show it, of the reference robot [s]."""

_LONGEST_NAME = 100

STARTS = (4.0, 2.0, 1.0, 0.5)
"""Times before the loss of balance at which a scenario may begin whose run is not the same to the bit [s]."""


@dataclass(frozen=True, slots=True)
class Trial:
    """A run with some of the causes.

    Attributes:
        causes: that acted.
        harm: what came to the robot; None where nothing did.
        same: whether that is the incident of the log.
        likeness: of its motion to that of the log; None where nothing came to it.
        refused: why it could not be run; empty where it could.
    """

    causes: tuple[Cause, ...]
    harm: Harm | None = None
    same: bool = False
    likeness: Likeness | None = None
    refused: str = ""

    @property
    def text(self) -> str:
        """The outcome in words."""
        if self.refused:
            return f"cannot be run: {self.refused}"
        if self.harm is None:
            return "stays upright and meets its criteria"
        return self.harm.text + ("" if self.same else ", which is another incident")


@dataclass(frozen=True, slots=True)
class Incident:
    """The incident of a log.

    Attributes:
        log: of the run.
        scenario: of the run, as it can be run again.
        harm: what came to the robot.
        named: checks that name its causes.
        lost: time at which balance was lost before a fall [s]; None without one.
        notes: what of the run no scenario holds.
    """

    log: Log
    scenario: Scenario
    harm: Harm
    named: tuple[str, ...]
    lost: float | None
    notes: tuple[str, ...] = ()

    @classmethod
    def of(cls, path: Path) -> "Incident":
        """The incident of a log.

        Raises:
            LogError: the log cannot be read, or shows no incident.
            ScenarioError: it holds no scenario that can be run.
        """
        log = read(path)
        notes = tuple(_notes(log))
        text, place = attached_scenario(str(path), own_parts=True)
        scenario = read_scenario(text, place, path.stem)
        harm = harm_of(log, scenario.criteria)
        if harm is None:
            what = f"{path}: shows no incident: no fall, no fault that ended the run, and no criterion that was missed"
            raise LogError(f"{what}; give the log of a run that failed")
        gathered = digest(log)
        named = tuple(one.check for one in findings(gathered) if one.relation == "cause")
        lost = loss(RunView(gathered))
        return cls(log, scenario, harm, named, None if lost is None else lost.time, notes)

    def name_of(self, path: Path) -> str:
        """The name of the scenario in a file: its own, as far as a name may have its letters."""
        name = re.sub(r"[^A-Za-z0-9._-]+", "-", path.stem).strip("-._")
        return name[:_LONGEST_NAME] or "incident"

    @property
    def has_state(self) -> bool:
        """True of a log in whose states a run may begin, as those of a pendulum are not."""
        return "/measurement" in self.log.numeric

    @property
    def length(self) -> float:
        """Length of the time of the reference robot, for this one [-]."""
        return RunView(self.log).constants.similarity.time


def _notes(log: Log) -> Iterator[str]:
    if parts := log.metadata.get(PARTS_RECORD):
        yield f"its parts of a program ({', '.join(parts)}) are replaced by Surefoot's own"
    made, now = log.metadata.get(VERSIONS_RECORD, {}), relevant_versions()
    others = [name for name, version in now.items() if name in made and made[name] != version]
    if others:
        yield f"it was made by other versions: {', '.join(others)}".replace("source_digest", "Surefoot's own code")


@dataclass
class Trials:
    """Runs of scenarios that are held against an incident; each is made once and its log is not kept.

    Attributes:
        incident: of the log.
        name: of the scenarios.
        on_trial: called with each.
        made: so far.
    """

    incident: Incident
    name: str
    on_trial: Callable[[Trial], None] = lambda _: None
    made: list[Trial] = field(default_factory=list)

    def __call__(self, values: Values, causes: tuple[Cause, ...] = ()) -> Trial:
        """Run a scenario in which these causes act."""
        asked = {**values, "criteria": criteria_of(self.incident)}
        trial = self._trial(lambda: checked(asked, self.name), causes)
        self.made.append(trial)
        self.on_trial(trial)
        return trial

    def of_file(self, path: Path) -> Trial:
        """Run the scenario of a file."""
        return self._trial(lambda: load(path), ())

    def _trial(self, scenario_of: Callable[[], Scenario], causes: tuple[Cause, ...]) -> Trial:
        incident = self.incident
        try:
            scenario = scenario_of()
            with TemporaryDirectory(prefix="surefoot-") as folder:
                result = run_scenario(scenario, Path(folder))
                if result.interrupted:
                    raise KeyboardInterrupt
                other = read(result.log)
                harm = harm_of(other, scenario.criteria)
                alike = None if harm is None else likeness(incident.log, incident.harm, other, harm)
                shutil.rmtree(result.log.parent)
        except (ScenarioError, SetupError, PluginError, LogError) as refusal:
            return Trial(causes, refused=" ".join(str(refusal).split()))
        return Trial(causes, harm, incident.harm.same(harm), alike)


def criteria_of(incident: Incident) -> dict[str, Any]:
    """The criteria that ask for what the incident is not: no fall, and what it has missed."""
    asked = incident.scenario.criteria
    missed = {name: asked[name].model_dump(mode="json", exclude_none=True) for name in incident.harm.missed}
    return {"fell": False, **missed}


def checked(values: Values, name: str) -> Scenario:
    """The scenario of values; ScenarioError where it cannot be run."""
    return read_scenario(yaml.safe_dump({"name": name, **values}), name, name)


@dataclass(frozen=True, slots=True)
class Regression:
    """A scenario that shows the incident of a log again.

    Attributes:
        incident: of the log.
        begin: time of the log at which it begins [s]; 0 for the beginning of the run.
        starts: trials of beginnings, with their times [s].
        values: keys of the scenario.
        causes: everything that acted.
        needed: those of them without any single one of which it is no more this incident.
        trials: all runs that were made to find that out.
    """

    incident: Incident
    begin: float
    starts: tuple[tuple[float, Trial], ...]
    values: Values
    causes: tuple[Cause, ...]
    needed: tuple[Cause, ...]
    trials: tuple[Trial, ...]

    @property
    def again(self) -> Trial:
        """The run with all that acted then."""
        return dict(self.starts)[self.begin]

    @property
    def comes_back(self) -> bool:
        """True if that shows the incident."""
        return self.again.same

    def in_file(self, cause: Cause) -> Cause:
        """A cause that is needed, as it is numbered where all others are left out."""
        return causes_of(self.values)[self.needed.index(cause)]

    def without(self, cause: Cause) -> Trial | None:
        """The run with all that is needed but one; None where it was not made."""
        left = tuple(one for one in self.needed if one is not cause)
        return next((trial for trial in reversed(self.trials) if trial.causes == left), None)


def regression(
    incident: Incident, trials: Trials, around: float | None = None, seconds: float | None = None, small: bool = True
) -> Regression:
    """Find a scenario that shows an incident again.

    Args:
        incident: of the log.
        trials: makes the runs.
        around: moment that the scenario is to show, by default that of the incident [s].
        seconds: at which time before that it begins; by default it begins where the run began, and with a moment
            `BEFORE` that [s].
        small: whether to look for causes that it does without.
    """
    moment = incident.harm.time if around is None else around
    if around is not None and seconds is None:
        seconds = BEFORE * incident.length
    whole = shortened(incident)
    begins = _begins(incident, moment, seconds)
    starts = tuple(_starts(incident, trials, whole, begins, wanted=seconds is not None))
    begin = min(starts, key=_distance)[0]
    values = begun(whole, incident, begin)
    causes = needed = causes_of(values)
    if dict(starts)[begin].same and small:
        likely = suspected(causes, incident.named)

        def holds(part: tuple[Cause, ...]) -> bool:
            return trials(without(values, [one for one in causes if one not in part]), part).same

        needed = smallest(causes, holds, likely)
    values = without(values, [one for one in causes if one not in needed])
    return Regression(incident, begin, starts, values, causes, needed, tuple(trials.made))


def _begins(incident: Incident, moment: float, seconds: float | None) -> Sequence[float]:
    """Times at which a scenario may begin, the wanted one first, each once [s]."""
    if not incident.has_state:
        return (0.0,)
    if seconds is not None:
        wanted = [moment - seconds, moment - 0.5 * seconds, moment - 0.25 * seconds, 0.0]
    else:
        before = incident.harm.time if incident.lost is None else incident.lost
        wanted = [0.0, *(before - one * incident.length for one in STARTS)]
    return tuple(dict.fromkeys(max(round(one, 6), 0.0) for one in wanted))


def _starts(
    incident: Incident, trials: Trials, whole: Values, begins: Sequence[float], wanted: bool
) -> Iterator[tuple[float, Trial]]:
    """Trials of beginnings, until one is the same to the bit, or a wanted one comes back [s]."""
    for begin in begins:
        values = begun(whole, incident, begin)
        trial = trials(values, causes_of(values))
        yield begin, trial
        alike = trial.likeness
        if trial.same and (wanted or (alike is not None and alike.parts is None)):
            return


def _distance(start: tuple[float, Trial]) -> float:
    """Distance of the CoM from that of the log in a trial of a beginning, infinite where it does not come back [m]."""
    trial = start[1]
    return trial.likeness.distance if trial.same and trial.likeness is not None else math.inf


def shortened(incident: Incident) -> Values:
    """The scenario of an incident, which ends a while after a fall of the log and holds nothing of what comes later."""
    values, harm = values_of(incident.scenario), incident.harm
    values.pop("criteria", None)
    values.get("controller", {}).pop("left_out", None)
    if not harm.fell:
        return values
    walk = resolve(incident.scenario)
    end = harm.time + AFTER * walk.size.time
    shorter = {**values, "duration": round(end, 6), **_before(harm.time, end, values, walk)}
    shorter = {name: value for name, value in shorter.items() if value != []}
    try:
        checked(shorter, "shortened")
    except ScenarioError:  # of something that has to last longer
        return values
    return shorter


def _before(time: float, end: float, values: Values, walk: Walk) -> Mapping[str, Any]:
    """The pushes, commands and faults of values that begin before a time, in a run up to another one [s]."""
    late = {one.key[:2] for one in due(walk) if one.event.time >= time}
    found: dict[str, Any] = {}
    for name in ("pushes", "commands", "faults"):
        entries = enumerate(values.get(name, ()))
        found[name] = [one for index, one in entries if (name, index) not in late and (one.get("time") or 0.0) < time]
    for fault in found["faults"]:
        if fault.get("time", 0.0) + fault.get("duration", 0.0) > end:
            del fault["duration"]
    return found


def begun(values: Values, incident: Incident, begin: float) -> Values:
    """The scenario that begins in the state of the log at a time; what was over by then is in the log [s].

    At 0 it is the run from its beginning.
    """
    if begin == 0.0:
        return values
    path = str(incident.log.path.resolve())
    left = [one for one in values.get("pushes", ()) if not _is_over(one, begin)]
    plant = {"plant": {"name": "log", "options": {"log": path, "until": begin}}}
    rest = {name: value for name, value in values.items() if name != "pushes"}
    return {**rest, **({"pushes": left} if left else {}), **plant}


def _is_over(push: Mapping[str, Any], time: float) -> bool:
    begin = push.get("time")
    return begin is not None and float(begin) + float(push.get("duration", 0.1)) <= time


def portable(values: Values, folder: Path) -> Values:
    """The scenario with paths of files as they are from a folder, and any policy in its place, also a mended one."""
    found = dict(values)
    if is_file(str(found.get("robot", ""))):
        found["robot"] = os.path.relpath(found["robot"], folder)
    if "controller" in found:
        found["controller"] = {name: one for name, one in found["controller"].items() if name != "digest"}
        if "policy" in found["controller"]:
            found["controller"]["policy"] = os.path.relpath(found["controller"]["policy"], folder)
    plant = found.get("plant", {})
    if plant.get("name") == "log":
        options = {**plant["options"], "log": os.path.relpath(plant["options"]["log"], folder)}
        found["plant"] = {**plant, "options": options}
    return found


def write(found: Regression, path: Path, comment: Sequence[str], replaced: bool = False) -> None:
    """Write the scenario with a comment.

    Raises:
        LogError: the file exists, and shall not be replaced, or cannot be written.
    """
    values = {
        "name": found.incident.name_of(path),
        **portable(found.values, path.resolve().parent),
        "criteria": criteria_of(found.incident),
    }
    head = "".join(f"# {line}\n" for line in comment)
    text = head + yaml.safe_dump(values, sort_keys=False, default_flow_style=None, allow_unicode=True, width=120)
    with write_whole(path, replaced) as temporary:
        temporary.write_text(text, encoding="utf-8")
