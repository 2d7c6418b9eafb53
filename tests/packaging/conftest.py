"""Fixtures: the distributions of this tree, built without a network, and the wheel as an installer unpacks it."""

import subprocess
import sys
import tarfile
import zipfile
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]


def build(tree: Path, folder: Path, *targets: str) -> list[Path]:
    """Build distributions of a tree with the backend itself, which needs nothing that is not installed."""
    command = [sys.executable, "-m", "hatchling", "build", "-d", str(folder), *targets]
    subprocess.run(command, cwd=tree, check=True, capture_output=True, timeout=60)
    return sorted(folder.iterdir())


@pytest.fixture(scope="session")
def distributions(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, Path]:
    """Wheel and sdist."""
    wheel, sdist = build(ROOT, tmp_path_factory.mktemp("dist"))
    return wheel, sdist


@pytest.fixture(scope="session")
def wheel_from_sdist(distributions: tuple[Path, Path], tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The wheel that an installer makes of the sdist."""
    folder = tmp_path_factory.mktemp("sdist")
    with tarfile.open(distributions[1]) as archive:
        archive.extractall(folder, filter="data")
    (tree,) = folder.iterdir()
    (wheel,) = build(tree, tmp_path_factory.mktemp("again"), "-t", "wheel")
    return wheel


@pytest.fixture(scope="session")
def unpacked(distributions: tuple[Path, Path], tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Folder for the path that holds what the wheel installs."""
    folder = tmp_path_factory.mktemp("site")
    with zipfile.ZipFile(distributions[0]) as archive:
        archive.extractall(folder)
    return folder
