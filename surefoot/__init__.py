"""Surefoot: a humanoid walking stack in full physics."""

from typing import TYPE_CHECKING, Any

__version__: str

if not TYPE_CHECKING:  # a type checker shall still refuse names that are not there

    def __getattr__(name: str) -> Any:
        """What takes time to get, when it is first asked for."""
        if name == "__version__":
            from importlib.metadata import PackageNotFoundError, version

            try:
                return version("surefoot")
            except PackageNotFoundError:  # a source tree on the path that was never installed
                return "0+unknown"
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
