"""Animations as WebP, a third of a GIF's size."""

from collections.abc import Sequence
from pathlib import Path

from PIL import Image
from sources import KEY, digest

QUALITY = 60
"""Quality of WebP: thin marks keep their edges."""


def save_webp(path: Path, images: Sequence[Image.Image], period: int, quality: int = QUALITY, method: int = 4) -> None:
    """Write pictures, shown for a period each [ms], as an animation without end, with the digest of its sources."""
    first, *rest = images
    note = f"{KEY}={digest(path.name)}".encode()
    first.save(
        path,
        save_all=True,
        append_images=rest,
        duration=period,
        loop=0,
        quality=quality,
        method=method,
        xmp=note,
    )
