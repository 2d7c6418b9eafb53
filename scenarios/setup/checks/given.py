"""The keys that a scenario gives, as against those that follow from others or have their defaults."""

import math
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from typing import Any

from surefoot.scenarios.file.schema import Scenario
from surefoot.scenarios.file.units import is_number
from surefoot.scenarios.setup.robot.robots import Robots
from surefoot.scenarios.setup.sized import unsaid


@dataclass(frozen=True, slots=True)
class Given:
    """The keys of a scenario that have another value than they would have if it did not give them.

    So a key that follows from others, such as `gait.speed`, is none of them, and one that is given beside those is. A
    key that is given the value that it has anyway asks for nothing. A log, which has every key with its value, says
    as much as the file that it was made from.

    Attributes:
        scenario: with what follows from its robot and its speed.
        robots: that it may name.
    """

    scenario: Scenario
    robots: Robots = field(default_factory=Robots)

    def of(self, group: str, names: Iterable[str]) -> Iterator[str]:
        """List those of some keys of a group, dotted."""
        settings = getattr(self.scenario, group)
        values = ((name, getattr(settings, name)) for name in names)
        return (
            f"{group}.{name}"
            for name, value in values
            if not _same(value, unsaid(self.scenario, group, name, self.robots))
        )

    @property
    def straight_knees(self) -> bool:
        """True if it gives ``planner.knee: straight``."""
        return self.scenario.planner.knee == "straight" and any(self.of("planner", ("knee",)))


def _same(value: Any, other: Any) -> bool:
    """Return true if two values of a key are equal but for rounding."""
    return bool(value == other) or (is_number(value) and is_number(other) and math.isclose(value, other))
