"""The parts of a verdict that the last part of a run, kept by a flight recorder, cannot give."""

from collections.abc import Iterator, Mapping

from surefoot.scenarios.file.criteria import Bound
from surefoot.scenarios.file.schema import Scenario
from surefoot.scenarios.judge.digest import RunView
from surefoot.scenarios.judge.metrics import known
from surefoot.scenarios.log import Kept
from surefoot.scenarios.record.provenance import Agenda

_SAID = 6


def kept_note(kept: Kept) -> str:
    """Note on what a log has of its run."""
    since = f"the log keeps the run from {kept.begin:.3f} s on (log.keep {kept.keep:g} s)"
    return f"{since}; {kept.dropped} messages before are dropped"


def is_measured(name: str) -> bool:
    """Return true if the last part of a run gives a metric, of which the name may be a part after a dot."""
    metric = known(name)
    return metric is not None and metric.at_end


def unmeasured(
    run: RunView, kept: Kept, criteria: Mapping[str, Bound], scenario: Scenario, agenda: Agenda
) -> Iterator[str]:
    """Report what a verdict asks for that was to be seen in the part that is dropped."""
    parts = [name for name in criteria if not is_measured(name)]
    if parts:
        more = f" and {len(parts) - _SAID} more" if len(parts) > _SAID else ""
        yield f"not measured, since {_dropped(kept)}: {', '.join(parts[:_SAID])}{more}"
    events = [f"{event.what} {event.time:.6g} s" for event in agenda.events if event.time <= kept.begin]
    events += [
        f"commands.{index} came at {command.time:g} s"
        for index, command in enumerate(scenario.commands)
        if not command.live and command.time <= kept.begin
    ]
    events += [f"{key} acts where feet stand on it" for key in run.constants.unforeseen]
    if run.constants.waypoints:
        events.append("gait.waypoints begin at 0 s")
    for event in events:
        yield f"{event}, and whether it acted was not measured, since {_dropped(kept)}"


def _dropped(kept: Kept) -> str:
    return f"the log has nothing before {kept.begin:.3f} s"
