"""The page of a campaign."""

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from surefoot.scenarios.sweep.sweep import Swept


def write_page(swept: "Swept") -> None:
    """Write ``report.html``."""
