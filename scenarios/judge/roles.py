"""Which joint is what: by the roles that a log carries, and in logs without them by the joints' names."""

import re
from collections.abc import Mapping, Sequence

Roles = Mapping[str, Sequence[str]]
"""Names of joints or bodies by role: knees, left_leg, right_leg, torso."""

_LEG = re.compile(r"hip|knee|ankle|leg")


def knees(names: Sequence[str], roles: Roles) -> list[int]:
    """Indices of the knees among the joints."""
    found = roles.get("knees")
    return [i for i, name in enumerate(names) if ("knee" in name if found is None else name in found)]


def leg(names: Sequence[str], roles: Roles, side: str) -> list[int]:
    """Indices of the joints of the ``left`` or ``right`` leg."""
    found = roles.get(f"{side}_leg")
    if found is None:
        return [i for i, name in enumerate(names) if side_of(name) == side and _LEG.search(name)]
    return [i for i, name in enumerate(names) if name in found]


def side_of(name: str) -> str:
    """The side that a joint's name tells: left, right or none."""
    return next((side for side in ("left", "right") if side in name), "")


def torso(roles: Roles) -> str:
    """Name of the torso's body."""
    return next(iter(roles.get("torso", ())), "torso")
