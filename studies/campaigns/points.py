"""The runs of a campaign: which there are, and which come after which."""

import zlib
from collections.abc import Generator, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np

from surefoot.scenarios.many.points import Point, Record, Search, folder_name
from surefoot.scenarios.many.search import search
from surefoot.studies.campaigns.campaign import SCENARIO, SEARCH, Campaign
from surefoot.studies.campaigns.spec import Draw


@dataclass(frozen=True, slots=True)
class Cell:
    """Runs that are made one after another, a single one or a search: of some labels, keys and seeds of a campaign."""

    campaign: Campaign
    labels: Mapping[str, Any]
    keys: Mapping[str, Any]
    seeds: Sequence[int]

    def search(self) -> Search:
        """Its runs."""
        bisect = self.campaign.bisect(self.keys)
        if bisect is not None:
            return search(partial(self._passes, bisect.key), bisect)
        return self._first_accepted()

    def _first_accepted(self) -> Search:
        """The one run; where a key has several values to try, the first that is not refused."""
        tried = [(key, value) for key, values in self.campaign.spec.first.items() for value in values]
        for key, value in tried or [("", None)]:
            record = yield self.point(self.seeds[0], {key: value} if key else {})
            if record.status != "refused":
                break
        return None

    def _passes(self, key: str, value: float) -> Generator[Point, Record, bool]:
        """Return true if every seed passes; the first that does not decides."""
        for seed in self.seeds:
            record = yield self.point(seed, {key: value})
            if record.status != "pass":
                return False
        return True

    def point(self, seed: int, searched: Mapping[str, Any]) -> Point:
        """A run of this cell with a seed, also of what is drawn, and with values of the keys that are searched."""
        spec = self.campaign.spec
        drawn = {key: draw_value(draw, spec.seed, key, seed) for key, draw in spec.sample.items()}
        own = {key: value for key, value in self.keys.items() if not key.startswith(SEARCH)}
        settings = {**own, **drawn, **searched}
        base = self.campaign.bases[str(settings.pop(SCENARIO, spec.scenario))]
        parts = {**self.labels, **searched, "seed": seed}
        labels = {**self.labels, **drawn, **searched, "seed": seed}
        return Point(base, {**settings, "seed": seed}, labels, folder_name(parts))


def cells(campaign: Campaign) -> Iterator[Cell]:
    """Every cell, in the order of the grid."""
    every = range(campaign.spec.seeds)
    for labels, keys in campaign.combinations():
        if campaign.spec.bisect is not None:
            yield Cell(campaign, labels, keys, every)
        else:
            yield from (Cell(campaign, labels, keys, (seed,)) for seed in every)


def draw_value(draw: Draw, campaign_seed: int, key: str, seed: int) -> Any:
    """A value drawn for a key and a seed, whatever else is drawn."""
    rng = np.random.default_rng([campaign_seed, seed, zlib.crc32(key.encode())])
    if draw.uniform is not None:
        return float(rng.uniform(draw.uniform[0], draw.uniform[1]))
    if draw.normal is not None:
        return float(rng.normal(draw.normal[0], draw.normal[1]))
    assert draw.choice is not None
    return draw.choice[int(rng.integers(len(draw.choice)))]
