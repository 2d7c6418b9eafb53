"""An off-screen OpenGL context from whatever library the machine has; nothing is touched before it is asked for.

MuJoCo chooses its library when it is first imported, and with `MUJOCO_GL=egl` and no EGL that import fails. Probing
the libraries at the time of use keeps rendering optional and independent of the order of imports.
"""

import ctypes
import importlib
import os
from collections.abc import Mapping
from typing import Any

BACKENDS = {"egl": "libEGL.so.1", "osmesa": "libOSMesa.so.8"}
"""MuJoCo's off-screen backends and their libraries, best first."""


class RenderingUnavailableError(RuntimeError):
    """No off-screen OpenGL on this machine."""


def make_context(width: int, height: int, backends: Mapping[str, str] | None = None) -> Any:
    """A current off-screen context of at least this many pixels, `free()` it after use.

    Args:
        width: of pictures [pixels].
        height: of pictures [pixels].
        backends: libraries that are tried, in this order; `BACKENDS` if None.

    Raises:
        RenderingUnavailableError: no library works; names the packages that bring one.
    """
    for backend, library in (BACKENDS if backends is None else backends).items():
        if _loads(library) and (context := _try_backend(backend, width, height)) is not None:
            return context
    raise RenderingUnavailableError(
        "no off-screen OpenGL was found for pictures and videos, install the Debian packages "
        "libegl1 libegl-mesa0 libgl1-mesa-dri, or libosmesa6"
    )


def _loads(library: str) -> bool:
    try:
        ctypes.CDLL(library)
    except OSError:
        return False
    return True


def _try_backend(backend: str, width: int, height: int) -> Any | None:
    """A context of this backend, or None if its driver refuses; the engine reads its choice from the environment.

    The environment is left as it was, since a child that imports MuJoCo with a choice loads OpenGL at once.
    """
    before = os.environ.get("MUJOCO_GL")
    os.environ["MUJOCO_GL"] = backend
    try:
        context = importlib.import_module(f"mujoco.{backend}").GLContext(width, height)
        context.make_current()
    except (ImportError, AttributeError, RuntimeError):
        return None
    finally:
        if before is None:
            del os.environ["MUJOCO_GL"]
        else:
            os.environ["MUJOCO_GL"] = before
    return context
