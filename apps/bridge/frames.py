"""Frames over a connection: what begins, how long it is and what it sums to, so that nothing else is taken for one."""

import contextlib
import select
import socket
import struct
import time
import zlib
from collections.abc import Callable
from enum import IntEnum
from typing import NamedTuple

from surefoot.scenarios.errors import LinkClosedError, LinkError

MAGIC, VERSION = b"SRFT", 1
_HEADER = struct.Struct("<4sBBHII")
"""Magic, version, kind, zero, bytes of the payload, CRC-32 of kind and payload; little-endian."""

LONGEST = 1 << 20
"""Bytes of a payload; no honest one is longer."""

_ONCE = 1 << 16


class Kind(IntEnum):
    """The content of a frame."""

    HELLO = 1
    WELCOME = 2
    REFUSED = 3
    RESET = 4
    PUSH = 5
    STATE = 6
    COMMAND = 7
    END = 8


class Frame(NamedTuple):
    """One message."""

    kind: Kind
    payload: bytes


def packed(kind: Kind, payload: bytes) -> bytes:
    """A frame as it goes over the wire."""
    return _HEADER.pack(MAGIC, VERSION, kind, 0, len(payload), _sum(kind, payload)) + payload


def _sum(kind: int, payload: bytes) -> int:
    return zlib.crc32(payload, kind)


class FrameReader:
    """Takes bytes as they come, and gives the frames in them.

    Args:
        longest: bytes of a payload that is taken.
    """

    def __init__(self, longest: int = LONGEST) -> None:
        self.longest, self._held = longest, bytearray()

    def feed(self, data: bytes) -> None:
        """Take bytes."""
        self._held += data

    def take(self) -> Frame | None:
        """The next frame, None as long as it is not whole.

        Raises:
            LinkError: what has come is no frame.
        """
        held = self._held
        if not MAGIC.startswith(held[:4]):
            raise LinkError(f"what has come begins with {bytes(held[:8])!r} and is no message of surefoot")
        if len(held) < _HEADER.size:
            return None
        _, version, kind, zero, size, checksum = _HEADER.unpack_from(held)
        if version != VERSION:
            raise LinkError(f"a message of protocol {version} where {VERSION} is spoken; use one version of surefoot")
        if size > self.longest:
            raise LinkError(f"a message of {size} bytes, of which {self.longest} are the most")
        if zero or kind not in Kind.__members__.values():
            raise LinkError(f"a message of unknown kind {kind}")
        if len(held) < _HEADER.size + size:
            return None
        payload = bytes(held[_HEADER.size : _HEADER.size + size])
        if _sum(kind, payload) != checksum:
            raise LinkError("a message whose checksum is wrong")
        del held[: _HEADER.size + size]
        return Frame(Kind(kind), payload)


class Link:
    """A connection that carries frames.

    Args:
        connection: connected; it is set up here, and closed by `close`.
        longest: bytes of a payload that is taken.
        reader: that has taken the first bytes of the connection; None for a fresh one.

    Attributes:
        peer: address of the other side.
    """

    def __init__(self, connection: socket.socket, reader: FrameReader | None = None) -> None:
        self._socket, self._reader, self._unsent = connection, reader or FrameReader(), b""
        connection.setblocking(False)
        connection.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        self.peer = shown(connection.getpeername())

    def send(self, kind: Kind, payload: bytes, patience: float) -> None:
        """Send a frame, whole.

        Args:
            kind: of the message.
            payload: of it.
            patience: how long the other side may take to read what came before [s].

        Raises:
            LinkError: it is gone, or takes nothing.
        """
        self._unsent += packed(kind, payload)
        deadline = time.monotonic() + patience
        while not self._flush():
            left = deadline - time.monotonic()
            if left <= 0.0 or not select.select([], [self._socket], [], left)[1]:
                raise LinkError(f"{self.peer} has taken no message for {patience:g} s")

    def offer(self, kind: Kind, payload: bytes) -> bool:
        """Send a frame if that can be done at once; return true if it was done; LinkError if the link is broken."""
        if not self._flush():
            return False
        self._unsent = packed(kind, payload)
        self._flush()
        return True

    def _flush(self) -> bool:
        """Send what was not; whether nothing is left."""
        while self._unsent:
            try:
                self._unsent = self._unsent[self._socket.send(self._unsent) :]
            except BlockingIOError:
                return False
            except OSError:
                raise LinkClosedError(f"{self.peer} has closed the connection") from None
        return True

    def receive(self, patience: float) -> Frame | None:
        """The next frame; None if none has come after so long [s].

        Raises:
            LinkError: the other side is gone, or what it sends is no frame.
        """
        deadline = time.monotonic() + patience
        while (frame := self._reader.take()) is None:
            left = max(deadline - time.monotonic(), 0.0)
            if not select.select([self._socket], [], [], left)[0]:
                return None
            try:
                data = self._socket.recv(_ONCE)
            except BlockingIOError:
                continue
            except OSError:
                data = b""
            if not data:
                raise LinkClosedError(f"{self.peer} has closed the connection")
            self._reader.feed(data)
        return frame

    def last_word(self) -> Frame | None:
        """The end that the other side has sent before it was gone; None if it has sent none."""
        with contextlib.suppress(LinkError):
            while (frame := self.receive(0.0)) is not None:
                if frame.kind is Kind.END:
                    return frame
        return None

    def close(self) -> None:
        """End the connection."""
        self._socket.close()


def shown(address: tuple[str | int, ...]) -> str:
    """An address as it is written."""
    return f"{address[0]}:{address[1]}"


def parsed(address: str, default_port: int) -> tuple[str, int]:
    """Host and port of an address as ``HOST``, ``HOST:PORT`` or ``:PORT``.

    Raises:
        LinkError: it is none.
    """
    host, _, port = address.rpartition(":") if ":" in address else (address, "", str(default_port))
    if not port.isdecimal() or not 0 < int(port) < 1 << 16:
        raise LinkError(f"{address!r} is no address of a plant; give it as 127.0.0.1:{default_port}")
    return host or LOOPBACK, int(port)


LOOPBACK = "127.0.0.1"
DEFAULT_PORT = 7447


def connected(address: str, patience: float, connect: Callable[..., socket.socket] = socket.create_connection) -> Link:
    """A link to a plant that is served at an address.

    Raises:
        LinkError: nobody is there.
    """
    host, port = parsed(address, DEFAULT_PORT)
    try:
        return Link(connect((host, port), timeout=patience))
    except OSError as error:
        why = error.strerror or str(error)
        raise LinkError(f"no plant at {host}:{port}, {why}; start one with: surefoot serve --port {port}") from None
