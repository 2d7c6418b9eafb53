"""Which version this is: what the installed distribution says of itself."""

from importlib.metadata import PackageNotFoundError, version

try:
    VERSION = version("surefoot")
except PackageNotFoundError:  # a source tree on the path that was never installed
    VERSION = "0+unknown"
