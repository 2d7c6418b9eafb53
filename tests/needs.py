"""Needs of some tests that a machine may lack: the only reasons for which a test is skipped.

Each need says what is missing, also where half of it is there: a browser without its driver, a library that gives no
context, a compiler that compiles nothing. So a test is run where it can be, and skipped where it cannot.
"""

import importlib.util
import os
import shlex
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from pathlib import Path

import pytest
from browser import Browser

from surefoot.native import modules
from surefoot.sim import gl


@dataclass(frozen=True)
class Need:
    """Something that is no part of ``.[dev]``.

    Attributes:
        name: what it is called in a reason.
        why: why a machine may lack it.
        lacks: says what of it is missing; empty where it is there.
    """

    name: str
    why: str
    lacks: Callable[[], str]

    @property
    def beginning(self) -> str:
        """Beginning of the reason of each skip for its want."""
        return f"needs {self.name}: "

    @property
    def reason(self) -> str:
        """Reason why a test that needs it is skipped; empty where it is there. It is looked for once."""
        return _reason(self)

    def or_skip(self) -> None:
        """Skip the test that asks, unless it is there."""
        if reason := self.reason:
            pytest.skip(reason)

    @property
    def mark(self) -> pytest.MarkDecorator:
        """Skips a test without it."""
        reason = self.reason
        return pytest.mark.skipif(bool(reason), reason=reason or "there")


@cache
def _reason(need: Need) -> str:
    lacks = need.lacks()
    return f"{need.beginning}{lacks}" if lacks else ""


def _lacks_browser() -> str:
    right = "apt-get install chromium chromium-driver"
    absent = [name for name in ("chromium", "chromedriver") if shutil.which(name) is None]
    if absent:
        return f"no {' and no '.join(absent)}, {right}"
    try:
        with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as profile, Browser("about:blank", Path(profile)):
            return ""
    except OSError as error:
        return f"chromedriver opens no page, {error}; {right}, both of one version"


def _lacks_opengl() -> str:
    try:
        gl.make_context(8, 8).free()
    except gl.RenderingUnavailableError as error:
        return str(error)
    return ""


def _lacks_compiler() -> str:
    command = shlex.split(os.environ.get("CC", "cc"))
    if not command or shutil.which(command[0]) is None:
        return "no C compiler"
    with tempfile.TemporaryDirectory() as folder:
        made = subprocess.run(
            [*command, "-shared", "-fPIC", "-o", str(Path(folder, "made")), "-x", "c", "-"],
            input=b"#include <math.h>\ndouble one(void) { return sqrt(1.0); }\n",
            capture_output=True,
            check=False,
        )
    return f"'{shlex.join(command)}' compiles nothing" if made.returncode else ""


def _lacks_compiled() -> str:
    return modules.missing()


def _lacks_modules(right: str, *names: str) -> str:
    absent = [name for name in names if importlib.util.find_spec(name) is None]
    return f"no {', '.join(absent)}, {right}" if absent else ""


def _lacks_mjlab() -> str:
    found = importlib.util.find_spec("mjlab")
    model = Path("asset_zoo", "robots", "unitree_g1", "xmls", "g1.xml")
    has = found is not None and any((Path(place) / model).exists() for place in found.submodule_search_locations or ())
    return "" if has else f"no {model.as_posix()} of it, pip install mjlab"


def _lacks_rerun() -> str:
    right = "pip install 'surefoot[rerun]'"
    program = Path(sys.executable).with_name("rerun")
    return _lacks_modules(right, "rerun") or ("" if program.exists() else f"no program {program.name}, {right}")


def _lacks_axe() -> str:
    axe = os.environ.get("AXE")
    return "" if axe and Path(axe).is_file() else "npm pack axe-core, and AXE=/path/to/axe.min.js"


def _lacks_linux() -> str:
    return "" if Path("/proc/self/status").exists() else "only Linux tells the memory of the program alone"


BROWSER = Need("a browser", "CI servers need not have one", _lacks_browser)
OPENGL = Need("off-screen OpenGL", "a machine may draw nothing", _lacks_opengl)
COMPILER = Need("a C compiler", "without one all else must pass", _lacks_compiler)
COMPILED = Need("compiled modules", "without a compiler all else must pass", _lacks_compiled)
SITE = Need(
    "the extra docs",
    "what builds the documentation site is no part of .[dev]",
    lambda: _lacks_modules("pip install -e '.[docs]'", "sphinx", "furo", "myst_parser", "sphinx_copybutton"),
)
AXE = Need("axe-core", "a package of npm, which looks at the site of the documentation", _lacks_axe)
MJLAB = Need("the package mjlab", "a package of others, which has one MJCF", _lacks_mjlab)
RERUN = Need("the package rerun", "a viewer of others, whose format changes with each version", _lacks_rerun)
POLICY = Need(
    "onnxruntime",
    "it is the extra policy, which runs networks",
    lambda: _lacks_modules("pip install 'surefoot[policy]' onnx", "onnxruntime", "onnx"),
)
LINUX = Need("Linux", "other systems do not tell it", _lacks_linux)

NEEDS = (BROWSER, OPENGL, COMPILER, COMPILED, SITE, AXE, MJLAB, RERUN, POLICY, LINUX)
