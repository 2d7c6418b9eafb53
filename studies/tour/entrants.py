"""Walkers of the tour and its beginning, by the words of a command."""

from collections.abc import Sequence
from pathlib import Path

from surefoot.errors import ParameterError
from surefoot.scenarios.errors import ScenarioError, nearest
from surefoot.studies.tour.draws import DRAWS
from surefoot.studies.tour.ride import STARTS, Setting
from surefoot.studies.tour.rows import ROWS
from surefoot.studies.tour.walker import Entrant


def entrants(rows: Sequence[str], policies: Sequence[Path]) -> list[Entrant]:
    """Rows by their names, in their own order, then policies by their files; all rows where neither is named.

    Raises:
        ScenarioError: a row is not known, a policy cannot walk the robot of the tour, or two have the same name.
    """
    for name in rows:
        if name not in ROWS:
            raise ScenarioError([f"g1-tour: no row '{name}'; {nearest(name, ROWS)}"])
    found: list[Entrant] = [row for name, row in ROWS.items() if name in rows or not (rows or policies)]
    if policies:
        from surefoot.studies.tour.learned import LearnedEntrant

        for file in policies:
            try:
                found.append(LearnedEntrant.of(file))
            except ParameterError as refusal:
                raise ScenarioError([str(refusal)]) from None
    names = [one.name for one in found]
    twice = next((name for name in names if names.count(name) > 1), None)
    if twice is not None:
        raise ScenarioError([f"g1-tour: two walkers are called '{twice}'; give their files or folders different names"])
    return found


def setting(start: str, draws: str) -> Setting:
    """Beginning of a tour, and its random numbers.

    Raises:
        ScenarioError: one of them is not known.
    """
    for what, named, known in (("start", start, STARTS), ("draws", draws, tuple(DRAWS))):
        if named not in known:
            raise ScenarioError([f"g1-tour: no {what} '{named}'; {nearest(named, known)}"])
    return Setting(start, draws)
