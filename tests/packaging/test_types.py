"""Findings of a type checker on programs that use the installed package: none if they are right, else every fault."""

import subprocess
import sys
import sysconfig
import venv
import zipfile
from pathlib import Path

import pytest

pytestmark = pytest.mark.physics

FACE = Path(__file__).with_name("whole_face.py").read_text(encoding="utf-8")


@pytest.fixture(scope="module")
def checked(tmp_path_factory, distributions):
    """Check files strictly against the unpacked wheel; gives the places of faults, file and line."""
    home = tmp_path_factory.mktemp("user")
    venv.create(home / "env", with_pip=False)
    (site,) = (home / "env").glob("lib/python*/site-packages")
    with zipfile.ZipFile(distributions[0]) as archive:
        archive.extractall(site)
    (site / "others.pth").write_text(f"{sysconfig.get_path('purelib')}\n")
    (home / "mypy.ini").write_text(
        "[mypy]\nstrict = true\n[mypy-mujoco.*,pinocchio.*]\nignore_missing_imports = true\n"
    )
    settings = ["--config-file", str(home / "mypy.ini"), "--cache-dir", str(home / "cache")]
    command = [sys.executable, "-m", "mypy", *settings, "--python-executable", str(home / "env" / "bin" / "python")]

    def check(folder, *files):
        done = subprocess.run([*command, *files], cwd=folder, capture_output=True, text=True, check=False)
        faults = [line for line in done.stdout.splitlines() if ": error: " in line]
        assert bool(faults) == bool(done.returncode), (done.stdout, done.stderr)
        return {(file, int(line)): text for file, line, text in (fault.split(":", 2) for fault in faults)}

    return check


FAULTS = {
    "return Whole(inner)": "return Law(inner.parameters, 1.0)",
    "return Hand(model, frames)": "return Believing",
    "PlannerParameters(), Law,": "PlannerParameters(), Hand,",
    "ours: Profile": "ours: Planner",
    "register(sway)": "register(whole)",
    'KINDS.add("mine", TerrainKind())': 'KINDS.add("mine", TerrainKind)',
    'TASKS.add("hand", Hand)': 'TASKS.add("hand", Believing)',
    "kind: TerrainKind": "kind: Task",
    'load("walk"': "load(4",
    "steps: int": "steps: str",
    "tasks=(hand,)": "tasks=(whole,)",
    "planner=profile, parts": 'planner="mine", parts',
    "passed: bool": "passed: Path",
    "result.log": "result.logg",
    '["/truth"].field("com")': '["/truth"].feild("com")',
    "    planner=profile,": "    planner=Law,",
    "controller=WholeBodyController,": "controller=4,",
    "    estimator=Believing,": "    estimator=Hand,",
    "tasks=[Hand]": "tasks=[Law]",
    "    plant=Still,": "    plant=Hand,",
    "sim.step()": "sim.stepp()",
    "tick.com[0]": "tick.comm[0]",
    "tick.reference.com[2]": "tick.reference.foot[2]",
    "phase: int": "phase: str",
    "tick.report.torque if tick.report is not None else None": "tick.report.torque",
    "None if tick.state is None else tick.state.q": "tick.state.q",
    "duration=0.1": 'duration="long"',
    "fell: bool": "fell: Path",
    "judge(surefoot.read(path))": "judge(path)",
}
"""Faults in place of what is right, each once in the program."""


def test_a_program_with_the_whole_face_and_the_package_of_the_documentation(tmp_path, checked, documented):
    (documented.folder / "my_package").rename(tmp_path / "my_package")
    wrong, faulty = FACE, set()
    for part, fault in FAULTS.items():
        assert FACE.count(part) == 1, part
        faulty.add(FACE[: FACE.index(part)].count("\n") + 1)
        wrong = wrong.replace(part, fault)
    (tmp_path / "right.py").write_text(FACE)
    (tmp_path / "wrong.py").write_text(wrong)
    found = checked(tmp_path, "right.py", "wrong.py", "my_package")
    assert not {place: fault for place, fault in found.items() if place[0] != "wrong.py"}
    assert {line for _, line in found} == faulty


def test_names_that_are_not_there_are_found(tmp_path, checked):
    (tmp_path / "wrong.py").write_text(
        "import surefoot\nversion: int = surefoot.__version__\nsurefoot.nothing\nfrom surefoot.planner import Nobody\n"
    )
    assert {line for _, line in checked(tmp_path, "wrong.py")} == {2, 3, 4}
