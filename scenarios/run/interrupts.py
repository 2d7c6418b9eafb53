"""Ctrl-C, and the signals by which others end a program: none of them may leave a log half closed."""

import math
import signal
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from types import FrameType

SIGNALS = (signal.SIGINT, signal.SIGTERM, *((signal.SIGHUP,) if hasattr(signal, "SIGHUP") else ()))

_PATIENCE = 3
"""Number of signals that are held back before one is obeyed wherever the program is."""

_HANGING = 2.0
"""Time for which a signal waits for the loop to look before it is obeyed wherever the loop hangs [s]."""

_received: list[int] = []


class Interrupted(KeyboardInterrupt):
    """A signal has come; of a type of its own, since Python takes a bare KeyboardInterrupt for Ctrl-C as it ends."""


def exit_code() -> int:
    """Exit code of a program that a signal has ended, as shells count: 130 Ctrl-C, 143 SIGTERM, 129 SIGHUP."""
    return 128 + (_received[-1] if _received else signal.SIGINT)


def obey_all() -> None:
    """Have every one of the signals end the program as Ctrl-C does, unless it is ignored, as under ``nohup``."""
    for number in SIGNALS:
        if signal.getsignal(number) is not signal.SIG_IGN:
            signal.signal(number, _obey)


def _obey(number: int, _: FrameType | None) -> None:
    _received.append(number)
    raise Interrupted


class Interrupts:
    """Signals that are held back.

    Attributes:
        count: how many there were.
    """

    def __init__(self) -> None:
        self.count = 0
        self._open = False
        self._again: threading.Timer | None = None
        self._obeyed = math.inf

    def look(self) -> None:
        """Raise `Interrupted` if a signal was held back. A loop calls it between two ticks."""
        if self.count:
            raise Interrupted

    @contextmanager
    def looked_for(self) -> Iterator[None]:
        """Expect the loop in this context to call `look`; a signal that waits too long raises `Interrupted` at once.

        That is the last resort: it may leave a message half added or a chunk unwritten.
        """
        self._open = True
        try:
            self.look()
            yield
        finally:
            self._open = False
            if self._again is not None:
                self._again.cancel()

    def note(self, number: int, _: FrameType | None) -> None:
        """Handle a signal."""
        self.count += 1
        _received.append(number)
        if self.count > _PATIENCE or (self._open and time.monotonic() >= self._obeyed):
            raise Interrupted
        if self._open and self._again is None:
            self._obeyed = time.monotonic() + _HANGING
            main = threading.main_thread().ident or 0
            self._again = threading.Timer(_HANGING, signal.pthread_kill, (main, number))
            self._again.daemon = True
            self._again.start()


@contextmanager
def held_back() -> Iterator[Interrupts]:
    """Hold the signals back; outside the main thread, where none arrives, nothing is done."""
    interrupts = Interrupts()
    if threading.current_thread() is not threading.main_thread():
        yield interrupts
        return
    before = {number: signal.getsignal(number) for number in SIGNALS}
    try:
        for number, handler in before.items():
            if handler is not signal.SIG_IGN:
                signal.signal(number, interrupts.note)
        yield interrupts
    finally:
        for number, handler in before.items():
            signal.signal(number, signal.SIG_DFL if handler is None else handler)
