"""Thresholds of two walkers as a figure takes them: by the angle of a direction, in place of its name."""

import math
from collections.abc import Sequence

from surefoot.scenarios.file.units import is_number
from surefoot.studies.campaigns.beside import WALKER
from surefoot.studies.campaigns.campaign import Campaign
from surefoot.studies.campaigns.spec import Axis, key_unit
from surefoot.studies.campaigns.thresholds import Found


def turned(campaign: Campaign, found: Sequence[Found], axes: Sequence[Axis]) -> tuple[list[Found], list[Axis]] | None:
    """Thresholds with the angle of each in place of the name of its direction, the walkers on the last axis.

    Returns:
        thresholds and axes as a compass takes them; None of a campaign without two walkers or without directions.
    """
    if all(axis.name != WALKER for axis in axes):
        return None
    name = next((name for name in campaign.axes if _angles(campaign, name)), None)
    if name is None:
        return None
    angles, key = _angles(campaign, name), next(iter(campaign.axes[name][0].keys))
    rows = []
    for one in found:
        labels = {axis: label for axis, label in one.labels.items() if axis != name}
        rows.append(Found({**labels, key: angles[str(one.labels[name])]}, one.threshold, one.range))
    kept = [axis for axis in axes if axis.name not in (WALKER, name)]
    walkers = next(axis for axis in axes if axis.name == WALKER)
    return rows, [*kept, Axis(key, tuple(angles.values())), walkers]


def _angles(campaign: Campaign, name: str) -> dict[str, float]:
    """Angle of each setting of an axis [rad]; none where its settings are something else."""
    found = {}
    for one in campaign.axes[name]:
        values = [value for key, value in one.keys.items() if key_unit(key) == "rad" and is_number(value)]
        if len(values) != 1 or len(one.keys) != 1:
            return {}
        found[str(one.label)] = math.remainder(float(values[0]), math.tau)
    return found
