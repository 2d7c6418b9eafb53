"""The page's way to the session: a websocket over which it sends what its user does, and hears what is new."""

import asyncio
import contextlib
import json
import threading
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from websockets.asyncio.server import ServerConnection

LONGEST_INPUT = 10_000
"""Characters of an input; no honest one is longer."""

DRAWN = "drawn"
"""Kind of what a page sends when it has drawn what it was sent last."""

PATIENCE = 2.0
"""Time that a page may draw until it gets something newer in any case [s]."""


@dataclass(slots=True, eq=False)
class _OpenPage:
    """A page, or a program that sends as one does: its loop, news to tell, whether and what it drew of them last."""

    loop: asyncio.AbstractEventLoop
    news: asyncio.Event = field(default_factory=asyncio.Event)
    drawn: asyncio.Event = field(default_factory=asyncio.Event)
    number: int | None = None


class PageChannel:
    """Takes what pages send, and tells them what is new, each as fast as it draws.

    Args:
        take: is given each input, on the thread of the sockets; a ValueError refuses it.
        left: is called when nobody looks at a page any more.
    """

    def __init__(self, take: Callable[[Mapping[str, Any]], None], left: Callable[[], None]) -> None:
        self._take, self._left = take, left
        self._lock, self._watchers = threading.Lock(), set[_OpenPage]()
        self._number, self._text, self._looked_at = 0, "", False

    @property
    def looked_at(self) -> bool:
        """Return true if a page has been open until now."""
        return self._looked_at

    @property
    def drawn(self) -> bool:
        """Return true if every page has drawn what it was sent last, and there is one."""
        with self._lock:
            return {watcher.number for watcher in self._watchers} - {None} == {self._number}

    def tell(self, text: str) -> None:
        """Send to all who look at the page; a page that is too slow for it misses some."""
        with self._lock:
            self._number, self._text = self._number + 1, text
            for watcher in self._watchers:
                with contextlib.suppress(RuntimeError):  # the sockets are closed already
                    watcher.loop.call_soon_threadsafe(watcher.news.set)

    async def serve(self, connection: "ServerConnection") -> None:
        """Serve a page as long as it is open."""
        watcher = _OpenPage(asyncio.get_running_loop())
        with self._lock:
            self._watchers.add(watcher)
            self._looked_at = True
        watcher.news.set()
        telling = asyncio.create_task(self._tell(connection, watcher))
        try:
            async for given in connection:
                if refusal := self._taken(given, watcher):
                    await connection.send(json.dumps({"refused": refusal}))
        finally:
            telling.cancel()
            with self._lock:
                self._watchers.discard(watcher)
                nobody = not self._watchers
            if nobody:
                self._left()

    async def _tell(self, connection: "ServerConnection", watcher: _OpenPage) -> None:
        while True:
            await watcher.news.wait()
            watcher.news.clear()
            watcher.drawn.clear()
            with self._lock:
                number, text = self._number, self._text
            if text:
                await connection.send(text)
                with contextlib.suppress(TimeoutError):
                    await asyncio.wait_for(watcher.drawn.wait(), PATIENCE)
                if watcher.drawn.is_set() or watcher.number is not None:
                    watcher.number = number

    def _taken(self, given: str | bytes, watcher: _OpenPage) -> str:
        """Take what a page has sent; gives why not, if so."""
        try:
            read = read_object(given)
            if read.get("kind") == DRAWN:
                watcher.drawn.set()
            else:
                self._take(read)
        except ValueError as refusal:
            return str(refusal)
        return ""


def read_object(given: str | bytes) -> Mapping[str, Any]:
    """An object of JSON.

    Raises:
        ValueError: it is none, or longer or deeper than any honest one, with a sentence that says so.
    """
    if isinstance(given, bytes) or len(given) > LONGEST_INPUT:
        raise ValueError(f"an input is JSON text of at most {LONGEST_INPUT} characters")
    try:
        read = json.loads(given, parse_constant=_refuse)
    except (ValueError, RecursionError):  # numbers of more than 4,300 digits are a ValueError
        read = None
    if not isinstance(read, dict):
        raise ValueError('an input is a JSON object as in {"kind": "reset"}, without NaN, Infinity and deep lists')
    return read


def _refuse(name: str) -> None:
    raise ValueError(name)
