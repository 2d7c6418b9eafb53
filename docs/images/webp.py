"""Animations as WebP, a third of a GIF's size."""

from collections.abc import Sequence
from pathlib import Path

from PIL import Image

QUALITY = 60
"""Of WebP: thin marks keep their edges."""


def save_webp(path: Path, images: Sequence[Image.Image], period: int) -> None:
    """Write pictures, shown for a period each [ms], as an animation without end."""
    first, *rest = images
    first.save(path, save_all=True, append_images=rest, duration=period, loop=0, quality=QUALITY, method=4)
