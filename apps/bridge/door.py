"""The door of a plant: it lets in one controller, of this protocol and this robot, and nobody beside it."""

import contextlib
import selectors
import socket
import threading
import time
from collections.abc import Callable, Mapping
from queue import SimpleQueue
from typing import Any

from surefoot.apps.bridge.frames import FrameReader, Kind, Link, packed, shown
from surefoot.apps.bridge.messages import end_bytes, json_bytes, json_of
from surefoot.scenarios.errors import LinkError
from surefoot.scenarios.output import reason

PATIENCE = 2.0
"""Time within which a controller that comes has to say who it is [s]."""

MOST_WAITING, MOST_REFUSALS = 16, 20
"""Most connections that have not said who they are yet; most refusals that are printed."""

_LONGEST_HELLO = 1 << 16
_LOOK = 0.2


class Door:
    """Listens, on a thread of its own, and lets one in.

    Args:
        host: address to be bound to.
        port: to be bound to; 0 for any free one.
        examine: is given what a controller says of itself, and returns why it is refused; empty if it is not.
        welcome: message to a controller that is let in.
        say: called with one sentence on each that is refused.
        patience: time within which a controller that comes has to say who it is [s].

    Attributes:
        address: that is listened at.
        guests: the one who was let in.

    Raises:
        LinkError: the address cannot be had.
    """

    def __init__(
        self,
        host: str,
        port: int,
        examine: Callable[[Mapping[str, Any]], str],
        welcome: Mapping[str, Any],
        say: Callable[[str], None],
        patience: float = PATIENCE,
    ) -> None:
        self._patience = patience
        self._examine, self._welcome, self._say = examine, json_bytes(welcome), say
        try:
            self._listener = socket.create_server((host, port))
        except (OSError, OverflowError) as error:
            why = reason(error) if isinstance(error, OSError) else str(error)
            raise LinkError(f"{host}:{port} cannot be served at, {why}; choose another --port") from None
        self._listener.setblocking(False)
        self.address = shown(self._listener.getsockname())
        self.guests: SimpleQueue[Link] = SimpleQueue()
        self._guest, self._refusals, self._open = "", 0, True
        self._waiting: dict[socket.socket, tuple[FrameReader, float]] = {}
        self._thread = threading.Thread(target=self._watch, name="door", daemon=True)
        self._thread.start()

    def close(self) -> None:
        """Listen no more."""
        self._open = False
        self._thread.join(timeout=5 * _LOOK)
        for connection in (self._listener, *self._waiting):
            connection.close()

    def _watch(self) -> None:
        with selectors.DefaultSelector() as selector:
            selector.register(self._listener, selectors.EVENT_READ)
            while self._open:
                for key, _ in selector.select(_LOOK):
                    if key.fileobj is self._listener:
                        self._accept(selector)
                    else:
                        self._hear(selector, key.fileobj)  # type: ignore[arg-type]
                now = time.monotonic()
                for connection, (_, since) in list(self._waiting.items()):
                    if now - since > self._patience:
                        self._refuse(selector, connection, f"has not said who it is in {self._patience:g} s")

    def _accept(self, selector: selectors.BaseSelector) -> None:
        try:
            connection, _ = self._listener.accept()
        except OSError:
            return
        connection.setblocking(False)
        self._waiting[connection] = FrameReader(_LONGEST_HELLO), time.monotonic()
        selector.register(connection, selectors.EVENT_READ)
        if len(self._waiting) > MOST_WAITING:
            self._refuse(selector, connection, f"comes while {MOST_WAITING} others have not said who they are")

    def _hear(self, selector: selectors.BaseSelector, connection: socket.socket) -> None:
        """Take what one of those who wait says."""
        reader, _ = self._waiting[connection]
        try:
            data = connection.recv(_LONGEST_HELLO)
        except BlockingIOError:
            return
        except OSError:
            data = b""
        if not data:
            self._refuse(selector, connection, "has gone without a word")
            return
        try:
            reader.feed(data)
            frame = reader.take()
            if frame is None:
                return
            if frame.kind is not Kind.HELLO:
                raise LinkError(f"a message {frame.kind.name} before it has said who it is")
            refusal = self._examine(json_of(frame.payload, "greeting"))
        except LinkError as error:
            refusal = str(error)
        if self._guest and not refusal:
            refusal = f"the robot is walked by {self._guest} already; serve another one on a port of its own"
        if refusal:
            self._refuse(selector, connection, refusal)
            return
        selector.unregister(connection)
        del self._waiting[connection]
        try:
            guest = Link(connection, reader)
            guest.send(Kind.WELCOME, self._welcome, self._patience)
        except (LinkError, OSError):
            connection.close()
            return
        self._guest = guest.peer
        self.guests.put(guest)

    def _refuse(self, selector: selectors.BaseSelector, connection: socket.socket, why: str) -> None:
        selector.unregister(connection)
        del self._waiting[connection]
        who = "somebody"
        with contextlib.suppress(OSError):
            who = shown(connection.getpeername())
            connection.send(packed(Kind.REFUSED, end_bytes(why)))
        connection.close()
        self._refusals += 1
        if self._refusals <= MOST_REFUSALS:
            self._say(
                f"refused {who}: {why}" + ("; further ones are not reported" if self._refusals == MOST_REFUSALS else "")
            )
