"""Which version this is: what the installed distribution says of itself."""

from importlib.metadata import PackageNotFoundError, version

try:
    __version__ = version("surefoot")
except PackageNotFoundError:  # a source tree on the path that was never installed
    __version__ = "0+unknown"
