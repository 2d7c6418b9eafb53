"""Tables of a page on what becomes of each element of a model."""

from collections.abc import Iterable, Iterator

from page_table import table

from surefoot.models.robot_file.mjcf_schema import ELEMENTS, Elements, Fate
from surefoot.models.robot_file.urdf_schema import URDF_ELEMENTS

HEAD = ("elements", "in", "become", "why, or what would be right")


def mjcf_table() -> str:
    """Elements of an MJCF, and attributes that a robot does without."""
    return table(HEAD, _rows(ELEMENTS))


def urdf_table() -> str:
    """Elements of a URDF that somebody has looked at; any other is left out with a word."""
    return table(HEAD, _rows(URDF_ELEMENTS))


def _rows(groups: Iterable[Elements]) -> Iterator[list[str]]:
    """Elements that share a parent, a fate and a reason in one row, and below them their attributes by reason."""
    shared: dict[tuple[str, Fate, str], list[Elements]] = {}
    for group in groups:
        shared.setdefault((group.parent, group.fate, group.why), []).append(group)
    for (parent, fate, why), members in shared.items():
        yield [_names(one.tags for one in members), f"`{parent}`" if parent else "the root", fate.value, why]
        reasons: dict[tuple[str, str], list[str]] = {}
        for group in members:
            place = parent if parent == "actuator" else group.tags
            for one in group.left_out:
                reasons.setdefault((place, one.why), []).append(one.attributes)
        for (place, reason), attributes in reasons.items():
            yield [f"attributes {_names(attributes)}", f"`{place}`", Fate.LEFT_OUT.value, reason]


def _names(texts: Iterable[str]) -> str:
    return ", ".join(f"`{name}`" for name in dict.fromkeys(" ".join(texts).split()))
