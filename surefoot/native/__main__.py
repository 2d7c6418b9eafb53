"""Make the compiled kernels of a checkout, and say whether there are any."""

import sys

from surefoot.native.build import LIBRARY, build
from surefoot.native.library import VARIABLE, library

if __name__ == "__main__":
    if library() is not None:
        print(f"compiled kernels: {LIBRARY}")
        sys.exit(0)
    print(f"plain Python: {VARIABLE} is 0 or {build() or 'the library is not of these sources'}")
    sys.exit(1)
