"""Packages of strangers that are on the path for a test."""

import os
import subprocess
import sys
from pathlib import Path


class Site:
    """A folder on the path with a distribution in it that nobody has built: files, and a list of entry points.

    Attributes:
        folder: what goes onto the path.
        points: name and target of the entry points by group.
    """

    def __init__(self, folder: Path, name: str) -> None:
        self.folder, self._metadata = folder, folder / f"{name.replace('-', '_')}-1.0.dist-info"
        self.points: dict[str, dict[str, str]] = {}
        self._metadata.mkdir(parents=True)
        (self._metadata / "METADATA").write_text(f"Metadata-Version: 2.1\nName: {name}\nVersion: 1.0\n")

    def write(self, path: str, text: str) -> None:
        """Put a file into it."""
        (self.folder / path).parent.mkdir(parents=True, exist_ok=True)
        (self.folder / path).write_text(text, encoding="utf-8")

    def register(self, group: str, **points: str) -> None:
        """Add entry points."""
        self.points.setdefault(group, {}).update(points)
        sections = (
            f"[{group}]\n" + "".join(f"{n} = {t}\n" for n, t in of.items()) for group, of in self.points.items()
        )
        (self._metadata / "entry_points.txt").write_text("\n".join(sections))

    def run(self, *arguments: str) -> subprocess.CompletedProcess[str]:
        """Give a command of a user who has it on the path."""
        path = os.pathsep.join([str(self.folder), *filter(None, [os.environ.get("PYTHONPATH")])])
        command = [sys.executable, "-m", "surefoot", *arguments]
        environment = {**os.environ, "PYTHONPATH": path}
        return subprocess.run(
            command, env=environment, cwd=self.folder.parent, capture_output=True, text=True, timeout=120
        )
