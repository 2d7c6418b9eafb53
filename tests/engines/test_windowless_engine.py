"""The engine without its window library, which is there once it is asked for."""

import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

import surefoot

pytestmark = pytest.mark.unit


def said(code, **environment):
    """Output of a program."""
    done = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, check=True, env={**os.environ, **environment}
    )
    return done.stdout.split()


def test_windows_are_loaded_when_one_is_asked_for():
    pytest.importorskip("glfw")
    code = """
import sys
from surefoot.engines.windowless import mujoco
print("glfw" in sys.modules)
print(mujoco.GLContext.__module__, mujoco.Renderer.__module__)
print("glfw.library" in sys.modules)
"""
    assert said(code, MUJOCO_GL="") == ["False", "mujoco.glfw", "mujoco.rendering.classic.renderer", "True"]


@pytest.mark.parametrize("library", ["wrong", "osmesa", "egl", "off"])
def test_what_draws_nothing_needs_no_library_that_draws(library):
    code = """
import sys
from surefoot.engines.windowless import mujoco
print(mujoco.MjModel.from_xml_string("<mujoco/>").nbody, "OpenGL" in sys.modules)
"""
    assert said(code, MUJOCO_GL=library) == ["1", "False"]


def test_what_the_engine_has_not_got_is_said_as_ever():
    from surefoot.engines.windowless import mujoco

    with pytest.raises(AttributeError, match="module 'mujoco' has no attribute 'nothing'"):
        mujoco.nothing  # noqa: B018


def test_the_engine_is_the_one_that_others_import():
    ours, theirs = "from surefoot.engines.windowless import mujoco", "import mujoco as one"
    for first, second in ((ours, theirs), (theirs, ours)):
        assert said(f"{first}; {second}; print(one is mujoco)") == ["True"]


def test_the_package_imports_it_from_one_place():
    root = Path(surefoot.__file__).parent
    rooms = (root / room for room in ("planner", "wbc", "sim", "models", "scenarios", "studies", "apps"))
    found = [
        file
        for room in rooms
        for file in room.rglob("*.py")
        if re.search(r"(?m)^\s*(import mujoco\b|from mujoco\b)", file.read_text("utf-8"))
    ]
    assert not found
