"""The invented log as fixtures."""

from collections.abc import Callable
from pathlib import Path

import pytest
from invented_log import write

from surefoot.scenarios.log import Log, read


@pytest.fixture
def write_log(tmp_path: Path) -> Callable[..., Path]:
    """Writes a log by the arguments of `write` after the path."""
    return lambda **options: write(tmp_path / "log.mcap", **options)


@pytest.fixture(scope="session")
def log_path(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The invented log."""
    return write(tmp_path_factory.mktemp("replay") / "log.mcap")


@pytest.fixture
def log(log_path: Path) -> Log:
    """The invented log, opened."""
    return read(log_path)
