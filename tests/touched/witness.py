"""Functions that a process runs and files that it reads of the repository, by the hooks of the interpreter.

Compiled modules call the hook of `sys.setprofile` where Cython compiled them with its directive `profile`.
"""

import atexit
import json
import os
import sys
import threading
from collections.abc import Mapping
from pathlib import Path
from types import CodeType
from typing import Any

PLACE = "SUREFOOT_WITNESS"
"""Variable with the folder to which processes that are started write; without it they watch nothing."""


class Witness:
    """Watches this process from the moment on that it is made.

    Attributes:
        ran: code that was called, by its identity: the hash of code reads all of it.
        read: paths of files that were opened for reading.
    """

    def __init__(self) -> None:
        self.ran: dict[int, CodeType] = {}
        self.read: set[str] = set()
        sys.addaudithook(self._opened)
        threading.setprofile(self._called)
        sys.setprofile(self._called)

    def _called(self, frame: Any, event: str, argument: Any) -> None:
        if event == "call":
            code = frame.f_code
            self.ran[id(code)] = code

    def _opened(self, event: str, arguments: tuple[Any, ...]) -> None:
        if event != "open":
            return
        path, mode = arguments[:2]
        if isinstance(path, str) and not set(mode or "r") & set("wax+"):
            self.read.add(path)

    def write(self, path: Path) -> None:
        """Write what was seen so far."""
        sys.setprofile(None)
        ran = sorted({(code.co_filename, code.co_firstlineno) for code in self.ran.values()})
        told: Mapping[str, Any] = {"ran": ran, "read": sorted(map(os.path.abspath, self.read))}
        path.write_text(json.dumps(told), encoding="utf-8")


def begin() -> None:
    """Watch a process that was started, and write at its end; `sitecustomize` of a survey calls this."""
    folder = os.environ.get(PLACE)
    if not folder:
        return
    import multiprocessing.util

    seen = Witness()
    path = Path(folder, f"{os.getpid()}.json")
    atexit.register(seen.write, path)
    # Processes of `multiprocessing` end without what `atexit` knows.
    multiprocessing.util.Finalize(None, seen.write, (path,), exitpriority=0)
