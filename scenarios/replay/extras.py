"""Optional packages: imported when they are needed, and named with the command that installs them when missing."""

import importlib
from types import ModuleType

from scenarios.errors import LogError


class MissingExtraError(LogError):
    """An output needs a package that is not installed; the message says how to install it."""


def require(module: str, extra: str, purpose: str) -> ModuleType:
    """Import an optional package.

    Args:
        module: to import.
        extra: of the distribution that brings it.
        purpose: what needs it, for the message.

    Raises:
        MissingExtraError: it is not installed.
    """
    try:
        return importlib.import_module(module)
    except ImportError:
        install = f"pip install 'surefoot[{extra}]'"
        raise MissingExtraError(f"{purpose} needs the package {module}; install it with: {install}") from None
