"""A worker that runs experiments in the process of the tests."""

import pytest

from surefoot.scenarios.sweep.engine import perform
from surefoot.scenarios.sweep.journal import LOGS, SCRATCH


class HereWorker:
    """Runs where it is asked."""

    def __init__(self, folder):
        self._folder = folder

    def __call__(self, point):
        return perform(point, self._folder / SCRATCH, self._folder / LOGS, keep_all=True)

    def close(self):
        pass


@pytest.fixture(scope="session")
def worker():
    return HereWorker
