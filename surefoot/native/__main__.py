"""Compile the modules of a checkout, or let them run interpreted (``--interpreted``); says which they are."""

import sys

from surefoot.native.modules import BuildError, NothingCompilesError, build, interpret, made, missing, stale

if __name__ == "__main__":
    try:
        if "--interpreted" in sys.argv[1:]:
            interpret("that was asked for; run 'python -m surefoot.native' to compile them")
        else:
            build(stale())
    except NothingCompilesError as error:
        interpret(str(error))
    except BuildError as error:
        sys.exit(str(error))
    print(f"compiled: {made()}" if made() else f"interpreted, slower: {missing()}")
