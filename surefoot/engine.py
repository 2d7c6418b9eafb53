"""MuJoCo, whose window library is loaded when a window is asked for.

`import mujoco` imports glfw, which starts a process of its own to ask its library's version: a fifth of the import,
though no run opens a window. The engine is imported from here, everywhere.
"""

import sys
from importlib import import_module
from importlib.util import find_spec
from types import ModuleType
from typing import Any

__all__ = ["mujoco"]

_WINDOWS = "glfw"


class _Later(ModuleType):
    """Stands for a module that is imported when something of it is used."""

    def __getattr__(self, name: str) -> Any:
        if name.startswith("__"):
            raise AttributeError(name)
        return getattr(import_module(self.__name__), name)


if {"mujoco", _WINDOWS}.isdisjoint(sys.modules) and find_spec(_WINDOWS):
    sys.modules[_WINDOWS] = _Later(_WINDOWS)
    import mujoco

    del sys.modules[_WINDOWS]  # whoever else imports it shall have the module itself
else:
    import mujoco
