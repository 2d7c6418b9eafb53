"""The pytest plugin: a file ``*.scenario.yaml`` in a folder of tests is a test.

The scenario is run; the test passes when it meets its criteria and, where ``baselines/<name>.baseline.yaml`` lies
beside it, is no worse than that. One without a baseline fails where a baseline lies there that is of no scenario, for
then one of the two has a wrong name; so it does where ``baselines`` is no folder. The log of a failure is kept in
``runs/pytest`` below the root of pytest. Nothing of Surefoot is imported before such a file is met.

Letters of the ending may be great or small, and ``.yml`` is one too. What is named so and is no file, as a folder or a
link to nothing, is a test that fails.
"""

import os
import shutil
from collections.abc import Generator, Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest

if TYPE_CHECKING:
    from surefoot.scenarios.check.check import Case, Checked

ENDINGS = (".scenario.yaml", ".scenario.yml")


NAMED, STATUS = "scenario", "check"
"""Names of properties of a test that names requirements: the scenario's name, and the status of its check."""

_COLLECTED = pytest.StashKey[set[str]]()
"""Files of all scenarios that were collected, also of those that were left out then."""


def pytest_configure(config: pytest.Config) -> None:
    """Begin with no file."""
    config.stash[_COLLECTED] = set()


def pytest_sessionfinish(session: pytest.Session) -> None:
    """Tell the process that has begun this one, if pytest-xdist did, which files were collected."""
    if hasattr(session.config, "workeroutput"):
        collected = session.config.stash[_COLLECTED]
        session.config.workeroutput["surefoot"] = sorted(collected)


@pytest.hookimpl(optionalhook=True)
def pytest_testnodedown(node: Any) -> None:
    """Take what a process of pytest-xdist tells."""
    node.config.stash[_COLLECTED].update(getattr(node, "workeroutput", {}).get("surefoot", ()))


def pytest_terminal_summary(terminalreporter: Any, config: pytest.Config) -> None:
    """Print requirements against their state, if a scenario names any."""
    collected = config.stash[_COLLECTED]
    if not collected:
        return
    from surefoot.scenarios.check.requirements import PROPERTY, Requirements, Shown

    reports = [one for group in ("passed", "failed") for one in terminalreporter.stats.get(group, ())]
    ran = [one for one in reports if one.when == "call" and is_scenario(Path(one.fspath))]
    shown = []
    for one in ran:
        properties = dict(one.user_properties)
        names = [value for name, value in one.user_properties if name == PROPERTY]
        name, status = properties.get(NAMED, one.location[2]), properties.get(STATUS, one.outcome)
        shown.append(Shown.of(name, names, status, one.passed))
    files = [Path(config.rootpath, one.fspath) for one in ran]
    found = Requirements.held(shown, files, map(Path, sorted(collected)))
    if found.table:
        terminalreporter.section("requirements")
        for line in found.lines:
            terminalreporter.write_line(line)


def is_scenario(path: Path) -> bool:
    """Return true if a path is named as a scenario that is a test."""
    return path.name.lower().endswith(ENDINGS)


def pytest_collect_file(file_path: Path, parent: pytest.Collector) -> "ScenarioFile | None":
    """Take a scenario file as a file of tests."""
    return ScenarioFile.from_parent(parent, path=file_path) if is_scenario(file_path) else None


@pytest.hookimpl(wrapper=True, optionalhook=True)
def pytest_collect_directory(path: Path) -> "Generator[None, pytest.Collector | None, pytest.Collector | None]":
    """Add to what is found in a folder what is named as a scenario there and is no file, which pytest passes by."""
    found = yield
    if found is not None and (strange := _strange(path)):
        collect, folder = found.collect, found
        found.collect = lambda: [*collect(), *(_astray(folder, one) for one in strange)]  # type: ignore[method-assign]
    return found


def _strange(folder: Path) -> list[Path]:
    """Paths in a folder that are named as scenarios and are no regular files."""
    try:
        return sorted(path for path in folder.iterdir() if is_scenario(path) and not path.is_file())
    except OSError:  # reported by pytest
        return []


def _astray(folder: pytest.Collector, path: Path) -> "StrayTest":
    return StrayTest.from_parent(folder, name=path.name, path=path)


class StrayTest(pytest.Item):
    """Something that is named as a scenario and is none."""

    def runtest(self) -> None:
        """Fail with the message.

        Raises:
            MissedError: always.
        """
        what = "a link to nothing" if not os.path.exists(self.path) else "no regular file"  # noqa: PTH110
        raise MissedError(f"{self.path}: is named as a scenario and is {what}; make it a file, or rename or remove it")

    def repr_failure(self, excinfo: pytest.ExceptionInfo[BaseException], style: Any = None) -> str:
        """The failure without a traceback."""
        return str(excinfo.value)

    def reportinfo(self) -> tuple[Path, int, str]:
        """The place of the item."""
        return self.path, 0, f"scenario {self.name}"


class ScenarioFile(pytest.File):
    """A scenario file."""

    def collect(self) -> Iterator["ScenarioTest"]:
        """Its one test."""
        self.config.stash[_COLLECTED].add(str(self.path))
        ending = next(ending for ending in ENDINGS if self.path.name.lower().endswith(ending))
        yield ScenarioTest.from_parent(self, name=self.path.name[: -len(ending)])


class MissedError(Exception):
    """A scenario did not do what it should; says what."""


class ScenarioTest(pytest.Item):
    """The run of a scenario."""

    def runtest(self) -> None:
        """Run it.

        Raises:
            MissedError: it missed its criteria, is worse than its baseline, or has one of another name.
        """
        from surefoot.scenarios.check.check import cases, strays
        from surefoot.scenarios.check.report import lines_of
        from surefoot.scenarios.check.requirements import PROPERTY

        (case,) = cases([str(self.path)])
        checked = self._checked(case, self.config.rootpath / "runs" / "pytest")
        if names := case.scenario.requirements:
            self.user_properties += [*((PROPERTY, name) for name in names), (NAMED, case.scenario.name)]
            self.user_properties.append((STATUS, checked.status))
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

    def _checked(self, case: "Case", out: Path) -> "Checked":
        """The case held against its baseline: one run in this process, or seeds in one beside it."""
        from surefoot.scenarios.check.check import run_case
        from surefoot.scenarios.check.seeds import Running, check, seeds_of
        from surefoot.scenarios.many.slots import InterruptedRunsError

        if seeds_of(case) == 1:
            return run_case(case, out)
        try:  # in a folder of its own: pytest-xdist may run another scenario at the same time
            return check([case], Running(out / case.scenario.name, jobs=1))[0]
        except InterruptedRunsError:
            raise KeyboardInterrupt from None

    def repr_failure(self, excinfo: pytest.ExceptionInfo[BaseException], style: Any = None) -> str:
        """The missed criteria, without a traceback, unless it is a defect."""
        from surefoot.scenarios.errors import ScenarioError

        if isinstance(excinfo.value, MissedError | ScenarioError):
            return str(excinfo.value)
        return str(super().repr_failure(excinfo, style))

    def reportinfo(self) -> tuple[Path, int, str]:
        """The place of the item."""
        return self.path, 0, f"scenario {self.name}"
