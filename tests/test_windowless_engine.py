"""The engine without its window library, which is there once it is asked for."""

import re
import subprocess
import sys
from pathlib import Path

import pytest

import surefoot

pytestmark = pytest.mark.unit


def said(code):
    """What a program prints."""
    return subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout.split()


def test_windows_are_loaded_when_one_is_asked_for():
    pytest.importorskip("glfw")
    code = """
import sys
from surefoot.engine import mujoco
print("glfw" in sys.modules)
print(sys.modules["mujoco.glfw"].glfw.VISIBLE)
import glfw
print(glfw.VISIBLE, type(glfw).__name__, "glfw.library" in sys.modules, hasattr(mujoco, "GLContext"))
"""
    before, visible, *after = said(code)
    assert before == "False"
    assert after == [visible, "module", "True", "True"]


def test_the_engine_is_the_one_that_others_import():
    assert said("import mujoco as one; from surefoot.engine import mujoco; print(one is mujoco)") == ["True"]
    assert said("from surefoot.engine import mujoco; import mujoco as one; print(one is mujoco)") == ["True"]


def test_the_package_imports_it_from_one_place():
    root = Path(surefoot.__file__).parent
    rooms = (root / room for room in ("planner", "wbc", "sim", "models", "scenarios"))
    found = [
        file
        for room in rooms
        for file in room.rglob("*.py")
        if re.search(r"(?m)^\s*(import mujoco\b|from mujoco\b)", file.read_text("utf-8"))
    ]
    assert not found
