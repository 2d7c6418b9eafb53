"""Compile the modules of a checkout, or let them run interpreted (``--interpreted``); says which they are."""

import sys

from surefoot.native.modules import BuildError, build, interpret, made, stale

if __name__ == "__main__":
    if "--interpreted" in sys.argv[1:]:
        interpret()
    else:
        try:
            build(stale())
        except BuildError as error:
            sys.exit(f"interpreted, slower, since {error}")
    print(f"compiled: {made()}" if made() else "interpreted")
