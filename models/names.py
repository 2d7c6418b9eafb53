"""The robots that there are; what makes them is imported when one is asked for."""

from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import TYPE_CHECKING

from surefoot.parts.plugins import Declared

if TYPE_CHECKING:
    from surefoot.models.types import Robot

ENDINGS = (".yaml", ".yml")
"""Endings of robot files."""

SHIPPED = {file.stem: file for file in sorted((Path(__file__).parent / "robots").glob("*.yaml"))}
"""Robot files that come with this package, by name; their models come with other packages."""


class _FirstLines(Mapping[str, str]):
    """The first line of each robot's file; empty for the one that has no file."""

    def __getitem__(self, name: str) -> str:
        if name == REFERENCE:
            return ""
        return SHIPPED[name].read_text(encoding="utf-8").split("\n", 1)[0].lstrip("# ")

    def __iter__(self) -> Iterator[str]:
        return iter((REFERENCE, *SHIPPED))

    def __len__(self) -> int:
        return 1 + len(SHIPPED)


REFERENCE = "humanoid100"
"""The robot of the paper's table, which is made by code."""

ROBOTS: "Declared[Robot]" = Declared("surefoot.robots", _FirstLines(), "surefoot.models.registry")
"""Every robot that `robot: NAME` of a scenario can mean."""


def is_file(reference: str) -> bool:
    """Return true if a reference to a robot is the path of a robot file, and no name."""
    return reference.endswith(ENDINGS)
