"""Make the compiled kernels of a checkout, and say whether there are any."""

import os

from surefoot.native.build import LIBRARY, build
from surefoot.native.library import VARIABLE, library

if __name__ == "__main__":
    if library() is not None:
        print(f"compiled kernels: {LIBRARY}")
    elif os.environ.get(VARIABLE) == "0":
        print(f"plain Python, since {VARIABLE} is 0")
    else:
        print(f"plain Python, slower, since there is {build() or 'no library that can be loaded'}")
