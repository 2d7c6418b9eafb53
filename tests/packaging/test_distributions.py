"""Installed distributions: one import name, whole, wherever it is built from, and no name in a user's way."""

import os
import re
import subprocess
import sys
import sysconfig
import tarfile
import tomllib
import zipfile
from pathlib import Path

import pytest
import yaml
from packaging.tags import Tag, sys_tags

from surefoot.native import modules

pytestmark = pytest.mark.unit

ROOT = Path(__file__).parents[2]
PARTS = ("apps", "models", "planner", "scenarios", "sim", "studies", "wbc")
"""Folders of the root that the package holds as links, names that a user's own files may well have."""


def files_of(wheel):
    """Content of the files of a wheel by path; the list of hashes follows from the rest."""
    with zipfile.ZipFile(wheel) as archive:
        return {name: archive.read(name) for name in archive.namelist() if not name.endswith("/RECORD")}


def run(folder, unpacked, *command):
    """A command of a user whose environment holds the wheel."""
    environment = {**os.environ, "PYTHONPATH": str(unpacked)}
    return subprocess.run(
        [sys.executable, *command], cwd=folder, env=environment, capture_output=True, text=True, timeout=60
    )


def test_the_wheel_holds_the_package_whole_and_nothing_beside_it(distributions):
    walk = os.walk(ROOT / "surefoot", followlinks=True)
    paths = {Path(folder, name) for folder, _, names in walk for name in names if "__pycache__" not in folder}
    packed = {name: data for name, data in files_of(distributions[0]).items() if ".dist-info/" not in name}
    assert packed == {path.relative_to(ROOT).as_posix(): path.read_bytes() for path in paths}
    data = (
        "py.typed",
        "scenarios/show/kit/page.css",
        "studies/paper/claims.yaml",
        "studies/paper/sections.yaml",
        "scenarios/catalogue/walk.yaml",
    )
    assert {f"surefoot/{name}" for name in data} <= set(packed)


def test_the_wheel_of_the_sdist_is_the_same(distributions, wheel_from_sdist):
    assert files_of(wheel_from_sdist) == files_of(distributions[0])


def test_a_wheel_with_compiled_modules_is_of_its_platform_and_python(distributions):
    built = {path.as_posix() for path in modules.built()} <= files_of(distributions[0]).keys()
    assert built == (not modules.missing())
    *_, python, abi, system = distributions[0].stem.split("-")
    assert f"{python}-{abi}-{system}" == (modules.tag() if built else "py3-none-any")
    assert Tag(python, abi, system) in set(sys_tags()), "which an installer takes here"


def test_the_workflow_of_the_page_for_github_installs_the_wheel_that_is_built(distributions, tmp_path):
    (text,) = re.findall(r"(?s)```yaml\n(# \.github/.*?)```", (ROOT / "docs" / "checking.md").read_text("utf-8"))
    job = yaml.safe_load(text)["jobs"]["check"]
    (install,) = [step["run"] for step in job["steps"] if step.get("run", "").startswith("pip install")]
    (tmp_path / "wheels").mkdir()
    (tmp_path / "wheels" / distributions[0].name).touch()
    told = subprocess.run(
        ["sh", "-c", f"printf '%s\\n' {install}"], cwd=tmp_path, env={**os.environ, **job["env"]},
        capture_output=True, text=True, check=True,
    ).stdout.split("\n")  # fmt: skip
    assert f"wheels/{distributions[0].name}" in told


def test_the_tag_names_the_oldest_glibc_that_has_the_symbols_of_the_modules(monkeypatch):
    platform_tag = modules.platform_tag
    monkeypatch.setattr(sysconfig, "get_platform", lambda: "linux-x86_64")
    assert platform_tag([b"GLIBC_2.2.5", b"GLIBC_2.14"]) == "manylinux_2_17_x86_64"
    assert platform_tag([b"GLIBC_2.35 GLIBC_2.4"]) == "manylinux_2_35_x86_64"
    assert platform_tag([b"musl"]) == "linux_x86_64"
    monkeypatch.setattr(sysconfig, "get_platform", lambda: "macosx-11.0-arm64")
    assert platform_tag([b"GLIBC_2.35"]) == "macosx_11_0_arm64"


def test_without_a_compiler_the_wheel_is_whole_but_for_the_compiled_modules(wheel_from_sdist, wheel_without_compiler):
    assert wheel_without_compiler.stem.endswith("-py3-none-any")
    names = {name for name in files_of(wheel_from_sdist) if not name.endswith("/WHEEL")}
    without = {name for name in files_of(wheel_without_compiler) if not name.endswith("/WHEEL")}
    assert without == names - {path.as_posix() for path in modules.built()}


def test_the_sdist_holds_each_file_once(distributions):
    with tarfile.open(distributions[1]) as archive:
        names = [name.split("/", 1)[1] for name in archive.getnames()]
    assert len(names) == len(set(names))
    assert not [name for name in names if name.startswith(PARTS)]
    assert {"README.md", "LICENSE", "pyproject.toml", "PKG-INFO", "surefoot/planner/planner.py"} <= set(names)


def test_a_script_beside_namesakes_of_our_parts_gets_both(tmp_path, unpacked):
    for part in PARTS[:-1]:
        (tmp_path / f"{part}.py").write_text("MINE = True\n")
    (tmp_path / "wbc").mkdir()
    (tmp_path / "wbc" / "__init__.py").write_text("MINE = True\n")
    imports = "".join(f"import {part}\nassert {part}.MINE\n" for part in PARTS)
    (tmp_path / "script.py").write_text(
        imports + "import surefoot\nfrom surefoot.planner.planner import WalkingPlanner\n"
        "from surefoot.models.registry import describe\nfrom surefoot.sim.world import World\n"
        "from surefoot.wbc.controller import WholeBodyController\n"
        "from surefoot.scenarios.setup.load import load\n"
        "load('walk')\nprint(surefoot.__file__, World.__module__)\n"
    )
    done = run(tmp_path, unpacked, "script.py")
    assert done.returncode == 0, done.stderr
    assert done.stdout.split() == [str(unpacked / "surefoot" / "__init__.py"), "surefoot.sim.world"]


def test_the_version_has_one_owner(tmp_path, unpacked):
    version = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]["version"]
    assert run(tmp_path, unpacked, "-m", "surefoot", "--version").stdout == f"surefoot {version}\n"
    assert run(tmp_path, unpacked, "-c", "import surefoot; print(surefoot.__version__)").stdout == f"{version}\n"
    assert run(tmp_path, unpacked, "-c", "from surefoot import nothing").returncode == 1


def test_no_text_teaches_an_import_that_is_not_installed():
    """Ruff bans the bare names in code; this looks into documents, and into the programs inside tests."""
    told = [*ROOT.glob("*.md"), *(ROOT / "docs").glob("*.md"), *(ROOT / "tests").rglob("*.py")]
    starts = tuple(f"{word} {part}{end}" for word in ("import", "from") for part in PARTS for end in (".", " ", "\n"))
    bare = [
        f"{path.relative_to(ROOT)}:{number}"
        for path in told
        for number, line in enumerate(path.read_text().splitlines(keepends=True), start=1)
        if line.lstrip().startswith(starts)
    ]
    assert not bare
