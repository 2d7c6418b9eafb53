"""The campaigns that come with Surefoot."""

from pathlib import Path

ENDING = ".yaml"
"""Ending of specifications."""


def shipped() -> dict[str, Path]:
    """Files of the specifications, by name."""
    folder = Path(__file__).parent / "campaigns"
    return {path.name.removesuffix(ENDING): path for path in sorted(folder.glob(f"*{ENDING}"))}
