"""The campaigns that come with Surefoot."""

from pathlib import Path

ENDING = ".yaml"
"""Of specifications."""


def shipped() -> dict[str, Path]:
    """Their files, by name."""
    folder = Path(__file__).parent / "campaigns"
    return {path.name.removesuffix(ENDING): path for path in sorted(folder.glob(f"*{ENDING}"))}
