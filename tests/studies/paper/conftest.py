"""A worker that runs experiments in the process of the tests."""

import pytest

from surefoot.scenarios.many.engine import perform
from surefoot.scenarios.many.journal import LOGS, SCRATCH
from surefoot.scenarios.run.run import run_scenario


class HereWorker:
    """Runs where it is asked."""

    def __init__(self, folder, run=run_scenario):
        self._folder, self._run = folder, run

    def __call__(self, point):
        return perform(point, self._folder / SCRATCH, self._folder / LOGS, keep_all=True, run=self._run)

    def close(self):
        pass


@pytest.fixture(scope="session")
def worker():
    return HereWorker
