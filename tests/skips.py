"""Skipped tests are counted and named, and a skip for another reason than those of `needs` fails the session."""

from collections import Counter
from typing import Any

import pytest
from needs import NEEDS


def reasons(reports: list[Any]) -> Counter[str]:
    """Number of tests that were skipped for each reason."""
    found: Counter[str] = Counter()
    for report in reports:
        text = report.longrepr[-1] if isinstance(report.longrepr, tuple) else str(report.longrepr)
        found[" ".join(text.removeprefix("Skipped: ").split())] += 1
    return found


def unexpected(found: Counter[str]) -> list[str]:
    """Reasons that are not among those allowed."""
    return sorted(reason for reason in found if not reason.startswith(tuple(need.beginning for need in NEEDS)))


def _found(config: pytest.Config) -> Counter[str]:
    reporter = config.pluginmanager.get_plugin("terminalreporter")
    return reasons(reporter.stats.get("skipped", [])) if reporter else Counter()


@pytest.hookimpl(trylast=True)
def pytest_sessionfinish(session: pytest.Session, exitstatus: int) -> None:
    """Fail a session that would pass with a skip that nobody expects; with xdist its controller knows all of them."""
    nothing_failed = exitstatus in (pytest.ExitCode.OK, pytest.ExitCode.NO_TESTS_COLLECTED)
    if nothing_failed and unexpected(_found(session.config)):
        session.exitstatus = pytest.ExitCode.TESTS_FAILED


def pytest_terminal_summary(terminalreporter: Any, config: pytest.Config) -> None:
    """Count and name the skips."""
    found = _found(config)
    if not found:
        return
    terminalreporter.section(f"{found.total()} skipped")
    for reason, count in sorted(found.items()):
        terminalreporter.line(f"{count} x {reason}")
    for reason in unexpected(found):
        terminalreporter.line(f"unexpected skip: {reason}; install .[dev], or add a need to tests/needs.py", red=True)
