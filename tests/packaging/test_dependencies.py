"""Dependencies of the package: declared, pinned, free of the GPL, and named if missing."""

import importlib
import re
import shlex
import subprocess
import sys
import tomllib
from importlib.metadata import PackageNotFoundError, distribution
from pathlib import Path

import pytest
from packaging.requirements import Requirement
from packaging.specifiers import SpecifierSet
from packaging.utils import canonicalize_name
from sites import Site

from surefoot import version
from surefoot.scenarios.errors import MissingExtraError, require
from surefoot.version import install_command

pytestmark = pytest.mark.unit

ROOT = Path(__file__).parents[2]
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
COPYLEFT = re.compile(r"\bA?GPL|(?<!Lesser )General Public License|Affero", re.IGNORECASE)
"""Names of licences that would hold for a program as a whole that needs the package; the Lesser GPL does not."""

OF_EXTRAS = ("av", "viser", "websockets", "pyarrow", "pandas", "distributed", "rerun", "dartpy")
"""Modules that only an extra brings."""

_EVERYTHING = f"""
import pkgutil, sys
sys.modules.update(dict.fromkeys({OF_EXTRAS}))
import surefoot
for module in pkgutil.walk_packages(surefoot.__path__, "surefoot."):
    if module.name != "surefoot.__main__":
        __import__(module.name)
print(*sys.modules)
"""


def needed(requirements, extra="", installed=True):
    """Names of all packages that requirements bring with them on this machine, themselves included.

    Unless all must be installed, what one that is not would bring is not known.
    """
    found, ahead = set(), [(Requirement(text), extra) for text in requirements]
    while ahead:
        requirement, extra = ahead.pop()
        if requirement.marker and not requirement.marker.evaluate({"extra": extra}):
            continue
        name = canonicalize_name(requirement.name)
        for inner in ("", *requirement.extras):
            if (name, inner) not in found:
                found.add((name, inner))
                ahead += [(Requirement(text), inner) for text in declared(name, installed)]
    return {name for name, _ in found}


def declared(name, installed):
    """Requirements of a package; those of this one are the tree's, which may be younger than the installed."""
    if name == PROJECT["name"]:
        extras = PROJECT["optional-dependencies"].items()
        return [*PROJECT["dependencies"], *(f"{line}; extra == '{extra}'" for extra, lines in extras for line in lines)]
    try:
        return distribution(name).requires or []
    except PackageNotFoundError:
        assert not installed, f"{name} is required and not installed"
        return []


def licences(metadata):
    """Licence that a package declares; of a text only the first line, since texts quote the licences of others."""
    texts = (metadata.get(key, "").strip().split("\n")[0] for key in ("License-Expression", "License"))
    return [text for text in (*texts, *(metadata.get_all("Classifier") or ())) if not text.startswith("Topic")]


def copyleft(licence):
    """Return true if a licence leaves no choice but the GPL."""
    return all(COPYLEFT.search(choice) for choice in re.split(r"\bOR\b", licence))


@pytest.mark.parametrize(
    ("licence", "refused"),
    [
        ("GPL-2.0-or-later", True),
        ("AGPL-3.0-only", True),
        ("GPLv3", True),
        ("License :: OSI Approved :: GNU General Public License v2 (GPLv2)", True),
        ("License :: OSI Approved :: GNU Affero General Public License v3", True),
        ("BSD-3-Clause AND GPL-3.0-only", True),
        ("LGPL-3.0-or-later", False),
        ("License :: OSI Approved :: GNU Lesser General Public License v3 (LGPLv3)", False),
        ("MIT OR GPL-2.0-only", False),
        ("Apache-2.0", False),
    ],
)
def test_licences_are_told_apart(licence, refused):
    assert copyleft(licence) == refused


def test_nothing_that_is_required_is_under_the_gpl():
    names = needed(["surefoot"]) - {"surefoot"}
    assert {"mujoco", "pin", "libpinocchio", "numpy"} <= names
    assert not [(name, text) for name in names for text in licences(distribution(name).metadata) if copyleft(text)]


def test_the_constraints_pin_what_every_extra_needs():
    pins = dict(line.split("==") for line in (ROOT / "constraints.txt").read_text().splitlines())
    wanted = needed(["surefoot[dev]"]) | needed([f"surefoot[{','.join(PROJECT['optional-dependencies'])}]"], "", False)
    wanted -= {"surefoot"}
    assert wanted <= {canonicalize_name(name) for name in pins}
    assert not [version for version in pins.values() if not re.fullmatch(r"[\w.]+", version)]


def test_every_module_can_be_imported_without_the_extras():
    done = subprocess.run([sys.executable, "-c", _EVERYTHING], capture_output=True, text=True, timeout=60)
    assert done.returncode == 0, done.stderr
    assert {"surefoot.apps.drive.page", "surefoot.scenarios.many.engine"} <= set(done.stdout.split())


@pytest.mark.parametrize(("module", "extra"), [("av", "video"), ("viser", "replay")])
def test_a_missing_extra_says_how_to_install_it(module, extra, monkeypatch):
    monkeypatch.setitem(sys.modules, module, None)
    with pytest.raises(MissingExtraError, match=rf"a film needs the package {module}.*\[{extra}\]'"):
        require(module, extra, "a film")
    assert extra in PROJECT["optional-dependencies"]


def installed(monkeypatch, tmp_path, origin):
    """The module of a Surefoot that is installed below `tmp_path`, as pip says it was."""
    site = Site(tmp_path, "surefoot")
    if origin is not None:
        site.write("surefoot-1.0.dist-info/direct_url.json", origin)
    site.write("installed_version.py", Path(version.__file__).read_text(encoding="utf-8"))
    monkeypatch.syspath_prepend(str(tmp_path))
    monkeypatch.delitem(sys.modules, "installed_version", raising=False)
    return importlib.import_module("installed_version")


@pytest.mark.parametrize(
    ("origin", "named"),
    [
        (None, "'surefoot[video]'"),
        ('{"url": "file:///home/me/walks", "dir_info": {}}', "'surefoot[video] @ file:///home/me/walks'"),
        ('{"url": "file:///d/surefoot-0.1.0-py3.whl"}', "'surefoot[video] @ file:///d/surefoot-0.1.0-py3.whl'"),
        ('{"url": "https://x.org/s", "vcs_info": {"vcs": "git"}}', "'surefoot[video] @ git+https://x.org/s'"),
    ],
)
def test_the_install_command_is_of_where_it_came_from(monkeypatch, tmp_path, origin, named):
    command = installed(monkeypatch, tmp_path / "site", origin).install_command("video")
    assert command.endswith(f"pip install {named}")
    requirement = Requirement(shlex.split(command)[-1])
    assert (requirement.name, requirement.extras) == ("surefoot", {"video"})


def test_the_install_command_of_a_clone_is_that_of_the_readme(monkeypatch, tmp_path):
    readme = (ROOT / "README.md").read_text(encoding="utf-8")
    for folder in ("own", "other"):
        (tmp_path / folder).mkdir()
        (tmp_path / folder / "pip").touch(0o755)
    monkeypatch.setattr(sys, "executable", str(tmp_path / "own" / "python"))
    monkeypatch.setenv("PATH", str(tmp_path / "own"))
    monkeypatch.chdir(ROOT)
    assert install_command("replay,video") in readme
    monkeypatch.chdir(tmp_path)
    assert install_command("video") == f"pip install -c {ROOT}/constraints.txt -e '{ROOT}[video]'"
    monkeypatch.setenv("PATH", str(tmp_path / "other"))
    assert install_command("video").startswith(f"{sys.executable} -m pip install -c ")


def test_a_version_that_is_pinned_takes_every_release_of_the_oldest_python():
    """One needed 3.11.5, so that `make docs` failed on the 3.11.2 of Debian 12."""
    pinned = [line.partition("==")[0] for line in (ROOT / "constraints.txt").read_text().splitlines() if "==" in line]
    oldest, checked = f"{PROJECT['requires-python'].removeprefix('>=')}.0", 0
    for name in pinned:
        try:
            takes = distribution(name).metadata.get("Requires-Python")
        except PackageNotFoundError:  # of an extra that is not installed
            continue
        assert oldest in SpecifierSet(takes or ""), f"{name} needs Python {takes}"
        checked += 1
    assert checked > 60
