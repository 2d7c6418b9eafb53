"""Compiled kernels of what runs at every tick, and their plain fallback.

The C sources beside this file work on arrays that Python allocates, with sizes that come at run time, through ctypes
and so tied to no version of Python. Each kernel has its counterpart in Python, which says what it does, is used where
there is no compiler, and is what the kernel is tested against.

``library`` (in `surefoot.native.library`) gives the kernels. The library is made when the package is installed or its
wheel is built; ``python -m surefoot.native`` makes it by hand and says whether there is one. ``SUREFOOT_NATIVE=0`` asks
for plain Python.
"""

from surefoot.native.library import Bound, Library, library

__all__ = ["Bound", "Library", "library"]
