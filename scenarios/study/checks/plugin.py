"""The pytest plugin: a file ``*.scenario.yaml`` in a folder of tests is a test.

The scenario is run; the test passes when it meets its criteria and, where ``baselines/<name>.baseline.yaml`` lies
beside it, is no worse than that. One without a baseline fails where a baseline lies there that is of no scenario, for
then one of the two has a wrong name; so it does where ``baselines`` is no folder. The log of a failure is kept in
``runs/pytest`` below the root of pytest. Nothing of Surefoot is imported before such a file is met.
"""

import shutil
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

ENDING = ".scenario.yaml"


def pytest_collect_file(file_path: Path, parent: pytest.Collector) -> "ScenarioFile | None":
    """Take a scenario file as a file of tests."""
    if not file_path.name.endswith(ENDING):
        return None
    return ScenarioFile.from_parent(parent, path=file_path)


class ScenarioFile(pytest.File):
    """A scenario file."""

    def collect(self) -> Iterator["ScenarioTest"]:
        """Its one test."""
        yield ScenarioTest.from_parent(self, name=self.path.name.removesuffix(ENDING))


class MissedError(Exception):
    """A scenario did not do what it should; says what."""


class ScenarioTest(pytest.Item):
    """The run of a scenario."""

    def runtest(self) -> None:
        """Run it.

        Raises:
            MissedError: it missed its criteria, is worse than its baseline, or has one of another name.
        """
        from surefoot.scenarios.study.checks.check import cases, run_case, strays
        from surefoot.scenarios.study.checks.report import lines_of

        out = self.config.rootpath / "runs" / "pytest"
        (case,) = cases([str(self.path)])
        checked = run_case(case, out)
        astray = strays(case) if checked.status == "without baseline" else ()
        if astray:
            what = f"{astray[0]}: is of no scenario beside it; name it {case.baseline.name}, or remove it"
            if astray[0] == case.baseline.parent:
                what = f"{astray[0]}: is no folder of baselines; make it one, or remove it"
            raise MissedError("\n".join([checked.status, what]))
        if not checked.passed and checked.status != "without baseline":
            raise MissedError("\n".join([checked.status, *lines_of(checked)]))
        if checked.log is not None:
            shutil.rmtree(checked.log.parent)

    def repr_failure(self, excinfo: pytest.ExceptionInfo[BaseException], style: Any = None) -> str:
        """What was missed, without a traceback, unless it is a defect."""
        from surefoot.scenarios.errors import ScenarioError

        if isinstance(excinfo.value, MissedError | ScenarioError):
            return str(excinfo.value)
        return str(super().repr_failure(excinfo, style))

    def reportinfo(self) -> tuple[Path, int, str]:
        """Where it is."""
        return self.path, 0, f"scenario {self.name}"
