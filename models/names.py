"""The robots that there are; what makes them is imported when one is asked for."""

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from surefoot.parts.plugins import At, Declared, Own

if TYPE_CHECKING:
    from surefoot.models.types import Robot

ENDINGS = (".yaml", ".yml")
"""Endings of robot files."""

SHIPPED = {file.stem: file for file in sorted((Path(__file__).parent / "robots").glob("*.yaml"))}
"""Robot files that come with this package, by name; their models come with other packages."""


@dataclass(frozen=True, slots=True)
class _Shipped:
    """A robot of a file that comes with this package; it is said to be what the first line says."""

    file: Path

    @property
    def said(self) -> str:
        """The first line of the file, without its mark."""
        return self.file.read_text(encoding="utf-8").split("\n", 1)[0].lstrip("# ")

    def load(self) -> "Robot":
        """The robot, whose file is read when it is described."""
        from surefoot.models.registry import robot_of

        return robot_of(self.file)


REFERENCE = "humanoid100"
"""The robot of the paper's table, which is made by code."""

_OWN: dict[str, Own] = {
    REFERENCE: At("", "surefoot.models.humanoid100:HUMANOID100"),
    **{name: _Shipped(file) for name, file in SHIPPED.items()},
}

ROBOTS: "Declared[Robot]" = Declared("surefoot.robots", "surefoot.models.types:Robot", _OWN)
"""Every robot that `robot: NAME` of a scenario can mean."""


def is_file(reference: str) -> bool:
    """Return true if a reference to a robot is the path of a robot file, and no name."""
    return reference.endswith(ENDINGS)
