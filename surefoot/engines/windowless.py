"""MuJoCo, whose library of windows and pictures is loaded when one is drawn.

`import mujoco` loads the library that ``MUJOCO_GL`` names, though no run draws anything. By default that is glfw, which
starts a process of its own and takes a fifth of the import. Where the variable is wrong, or the machine lacks the
library, the import fails. The engine is imported from here, everywhere.
"""

import sys
from importlib import import_module
from typing import Any

__all__ = ["mujoco"]

_DRAWING = "mujoco.rendering.classic"
_DRAWN = {"GLContext": "gl_context", "Renderer": "renderer"}
"""Names of the engine that draw, and the modules of `_DRAWING` that have them."""


def _drawn(name: str) -> Any:
    """The engine's part that draws, loaded when it is asked for (PEP 562)."""
    if name not in _DRAWN:
        raise AttributeError(f"module 'mujoco' has no attribute '{name}'")
    return getattr(import_module(f"{_DRAWING}.{_DRAWN[name]}"), name)


if {"mujoco", _DRAWING}.isdisjoint(sys.modules):
    sys.modules[_DRAWING] = None  # type: ignore[assignment]  # the engine goes without what cannot be imported
    import mujoco

    del sys.modules[_DRAWING]
    mujoco.__getattr__ = _drawn
else:
    import mujoco
