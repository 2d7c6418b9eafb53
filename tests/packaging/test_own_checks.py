"""A stranger's scenarios, baselines and scenario tests, in a folder of their own with the wheel on the path."""

import os
import subprocess
import sys

import pytest

pytestmark = pytest.mark.physics

WALK = "fidelity: pendulum\ngait: {steps: 2, step_length: 0.2}\nrates: {control: 100}\ncriteria: {fell: false}\n"


@pytest.fixture
def give(tmp_path, unpacked):
    """Give a command in the stranger's folder."""

    def command(*words):
        environment = {**os.environ, "PYTHONPATH": str(unpacked)}
        whole = [sys.executable, "-m", *words]
        return subprocess.run(whole, cwd=tmp_path, env=environment, capture_output=True, text=True, timeout=120)

    return command


def test_a_strangers_baseline_is_written_holds_and_fails_when_the_walk_changes(give, tmp_path):
    (tmp_path / "pytest.ini").write_text("[pytest]\n")
    for name in ("held", "free"):
        (tmp_path / f"{name}.scenario.yaml").write_text(WALK)
    written = give("surefoot", "check", "held.scenario.yaml", "--update")
    assert written.returncode == 0, written.stderr
    assert "held.scenario: written\n  - baselines/held.scenario.baseline.yaml\n" in written.stdout
    ways = ("pytest", "-q", "-p", "no:cacheprovider", "-p", "no:xdist")
    passed = give(*ways)
    assert (passed.returncode, "2 passed" in passed.stdout) == (0, True), passed.stdout
    assert not list(tmp_path.glob("runs/pytest/*"))

    changed = tmp_path / "baselines" / "held.scenario.baseline.yaml"
    text = changed.read_text()
    before = next(line for line in text.splitlines() if line.strip().startswith("path_length"))
    changed.write_text(text.replace(before, "  path_length: 0.5"))
    failed = give(*ways, "-k", "held")
    assert (failed.returncode, "1 failed, 1 deselected" in failed.stdout) == (1, True), failed.stdout
    assert "path_length: 0.5 -> " in failed.stdout
    assert [path.parent.name for path in tmp_path.glob("runs/pytest/*/log.mcap")] == ["held.scenario-0"]

    assert give(*ways, "-p", "no:surefoot").returncode == 5  # pytest's code for no tests
