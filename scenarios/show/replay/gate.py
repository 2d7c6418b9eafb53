"""The one way to a viewer: a port of this machine, and a check that no page of others passes.

A browser lets any page send requests to this machine and connect to its sockets. So an answer is given only to requests
with the token in the path, from a page of this address or from no page at all. Their host has to be this machine; a
name that others point here is not.
"""

import asyncio
import contextlib
import importlib
import io
import logging
import re
import secrets
import socket
import warnings
from collections.abc import Awaitable, Callable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from http import HTTPStatus
from typing import TYPE_CHECKING, Any
from weakref import WeakSet

from surefoot.scenarios.errors import LogError, require
from surefoot.scenarios.output import reason

if TYPE_CHECKING:
    import viser
    from websockets.asyncio.server import ServerConnection
    from websockets.http11 import Request, Response

LOCALHOST = "127.0.0.1"
"""A viewer is for this machine alone."""

HOSTS = (LOCALHOST, "localhost", "[::1]")
"""Names of this machine; the port may be another one, that of a tunnel."""

PORT = 8080
"""The first to try."""

TRIES = 1000
"""Ports that are tried when none was asked for."""

LONGEST_MESSAGE = 100_000
"""Bytes of what a page sends at once; no honest message is longer."""

VIEWER = "viewer"
"""Name of the viewer's own page, where another one is served at the address."""

GRACE = 0.5
"""Time that a page has to take its leave when the viewer ends [s]."""

HEARD = ("ViewerCameraMessage", "GuiUpdateMessage", "SceneNodeClickMessage", "SceneNodeDragMessage")
"""Messages that the pages here send to viser, which knows more: uploads, and a tunnel to the internet."""

HEADERS = {"Cache-Control": "no-store", "Referrer-Policy": "no-referrer", "X-Frame-Options": "DENY"}
"""Headers of every page: its address holds the token, which nothing else shall learn."""

logger = logging.getLogger(__name__)
"""Logger of bad requests and broken connections, which are no business of the terminal."""
logger.addHandler(logging.NullHandler())
logger.propagate = False

Handler = Callable[["ServerConnection"], Awaitable[None]]
Answer = Callable[["ServerConnection", "Request"], "Response | None"]


@dataclass(slots=True)
class Gate:
    """Says whom a viewer answers, and what.

    Attributes:
        port: asked for, the first free one if None; once it serves, the one that is listened on.
        page: what is served in place of the viewer's own page, if anything.
        sockets: handlers of the websockets below the address, by name, beside the viewer's own at the address.
        token: part of the address, not to be guessed.
    """

    port: int | None = None
    page: str | None = None
    sockets: Mapping[str, Handler] = field(default_factory=dict)
    token: str = field(default_factory=lambda: secrets.token_urlsafe(16))

    @property
    def address(self) -> str:
        """Address of the page."""
        return f"http://{LOCALHOST}:{self.port}/{self.token}/"

    def refusal(self, request: "Request") -> str | None:
        """Reason why a request is not answered; None if it is."""
        hosts, origins = (request.headers.get_all(name) for name in ("Host", "Origin"))
        if len(hosts) != 1 or not is_here(hosts[0]):
            return f"this address is not served; open {LOCALHOST} or localhost"
        if origins and [origin.lower() for origin in origins] != [f"http://{hosts[0].lower()}"]:
            return "pages of others are not answered"
        token = request.path.split("?")[0].split("/")[1:2]
        if not secrets.compare_digest("".join(token).encode(errors="replace"), self.token.encode()):
            return "the address lacks its token; open the whole address that the command has said"
        return None

    def answered(self, connection: "ServerConnection", request: "Request", viewer: Answer) -> "Response | None":
        """The answer to a request, with the viewer's own page where that is asked for; None makes it a websocket."""
        if (refusal := self.refusal(request)) is not None:
            return connection.respond(HTTPStatus.FORBIDDEN, refusal + "\n")
        name = self._name(request)
        if "Upgrade" in request.headers:
            known = name == "" or name in self.sockets
            return None if known else connection.respond(HTTPStatus.NOT_FOUND, "no such socket\n")
        if name == "" and self.page is not None:
            response = connection.respond(HTTPStatus.OK, self.page)
            del response.headers["Content-Type"]
            response.headers["Content-Type"] = "text/html; charset=utf-8"
        elif name in ("", VIEWER):
            response = viewer(connection, replace(request, path="/")) or connection.respond(HTTPStatus.NOT_FOUND, "")
        else:
            return connection.respond(HTTPStatus.NOT_FOUND, "no such page\n")
        response.headers.update(HEADERS)
        return response

    async def handle(self, connection: "ServerConnection", viewer: Handler) -> None:
        """Serve a websocket that was let in."""
        assert connection.request is not None
        name = self._name(connection.request)
        if name in self.sockets:
            await self.sockets[name](connection)
        elif connection.subprotocol != f"viser-v{importlib.import_module('viser').__version__}":
            await connection.close(1002, "another version of viser; load the page anew")
        else:
            await viewer(_Screened(connection))  # type: ignore[arg-type]

    @staticmethod
    def _name(request: "Request") -> str:
        """Name of what is asked for, below the token."""
        return "/".join(request.path.split("?")[0].split("/")[2:])


class _Screened:
    """A viewer's websocket, on which nothing arrives that no page here would send."""

    def __init__(self, connection: "ServerConnection") -> None:
        self._connection = connection

    def __getattr__(self, name: str) -> Any:
        return getattr(self._connection, name)

    async def recv(self) -> str | bytes:
        while not is_heard(message := await self._connection.recv()):
            pass
        return message


def is_heard(message: str | bytes) -> bool:
    """Return true if viser may be given a message; it would set any attribute of a control that one names."""
    msgspec: Any = importlib.import_module("msgspec")
    try:
        given = msgspec.msgpack.decode(message if isinstance(message, bytes) else b"")
    except (msgspec.MsgspecError, ValueError, RecursionError):
        return False
    if not isinstance(given, dict) or given.get("type") not in HEARD:
        return False
    if given["type"] != "GuiUpdateMessage":
        return True
    match given.get("updates"):
        case {"value": bool() | int() | float() | str(), **others}:
            return not others
    return False


_HERE = re.compile(rf"(?:{'|'.join(map(re.escape, HOSTS))})(?::[0-9]{{0,5}})?", re.IGNORECASE)


def is_here(host: str) -> bool:
    """Return true if the host of a request is a name of this machine, with a port or none behind it."""
    return _HERE.fullmatch(host) is not None


@contextlib.contextmanager
def serving(gate: Gate | None = None) -> "Iterator[viser.ViserServer]":
    """A viewer for as long as the context lasts, silent on standard output; nobody can connect without a gate.

    Raises:
        MissingExtraError: viser is not installed.
        LogError: the port is taken; viser is one that the gate cannot stand before.
    """
    viser = require("viser", "replay", "the replay in a browser")
    with contextlib.closing(_bound(gate.port) if gate else socket.socket()) as listener:
        if gate is None:
            listener.bind((LOCALHOST, 0))
        else:
            gate.port = listener.getsockname()[1]
        with contextlib.redirect_stdout(io.StringIO()), _guarded(gate, listener) as guards:
            server = viser.ViserServer(host=LOCALHOST, port=0, verbose=False)
        try:
            if not guards:
                raise LogError(f"viser {viser.__version__}: cannot be guarded from other pages; install viser 1.1.1")
            yield server
        finally:
            for connections in guards:
                connections.end()
            with contextlib.redirect_stdout(io.StringIO()):
                server.stop()


@contextlib.contextmanager
def _guarded(gate: Gate | None, listener: socket.socket) -> Iterator[list["_Connections"]]:
    """Put the gate before the server of websockets that begins within the context; gives the connections of each.

    Viser has no way to ask for this. It serves by one call of `websockets.asyncio.server.serve`, so that all that is
    set here is what that function documents.
    """
    module: Any = importlib.import_module("websockets.asyncio.server")
    serve = module.serve
    guards: list[_Connections] = []

    def guarded(handler: Handler, *_: object, process_request: Answer, **options: Any) -> Any:
        loop = asyncio.get_running_loop()
        loop.set_exception_handler(_note)
        connections = _Connections(loop)
        warnings.filterwarnings("ignore", module=r"viser\b")  # of frames that are not as they should be
        places = {key: value for key, value in options.items() if key not in ("host", "port")}
        ours: dict[str, Any] = {"sock": listener, "logger": logger, "max_size": LONGEST_MESSAGE}
        if gate is None:
            ours["start_serving"] = False
        else:
            ours["process_request"] = lambda connection, request: gate.answered(connection, request, process_request)
            ours["create_connection"] = _answering(module.ServerConnection, connections)
        guards.append(connections)
        return serve(handler if gate is None else lambda connection: gate.handle(connection, handler), **places | ours)

    module.serve = guarded
    try:
        yield guards
    finally:
        module.serve = serve


def _note(_: asyncio.AbstractEventLoop, context: dict[str, Any]) -> None:
    logger.debug("%s", context.get("message"), exc_info=context.get("exception"))


@dataclass(slots=True)
class _Connections:
    """All connections to the server of a loop that are still there."""

    loop: asyncio.AbstractEventLoop
    made: WeakSet[Any] = field(default_factory=WeakSet)

    def end(self) -> None:
        """End all, after a grace also those whose other side answers nothing, for which the server would wait."""
        with contextlib.suppress(RuntimeError):  # the loop is closed already
            self.loop.call_soon_threadsafe(self.loop.call_later, GRACE, self._abort)

    def _abort(self) -> None:
        for connection in list(self.made):
            connection.transport.abort()


def _answering(connection: Any, connections: _Connections) -> Any:
    """A kind of connection that also answers what is no GET request, which websockets closes without a word."""

    class Connection(connection):  # type: ignore[misc]
        begun = b""

        def connection_made(self, transport: asyncio.BaseTransport) -> None:
            super().connection_made(transport)
            connections.made.add(self)

        def data_received(self, data: bytes) -> None:
            self.begun += data[: len(_GET) - len(self.begun)]
            if _GET.startswith(self.begun):
                super().data_received(data)
            elif not self.transport.is_closing():
                self.transport.write(_NO_GET)
                self.transport.close()

    return Connection


_GET, _SENTENCE = b"GET ", b"pages are read with GET, and all else goes through their websockets\n"
_NO_GET = (
    b"HTTP/1.1 405 Method Not Allowed\r\nAllow: GET\r\nConnection: close\r\n"
    b"Content-Type: text/plain; charset=utf-8\r\nContent-Length: %d\r\n\r\n%s" % (len(_SENTENCE), _SENTENCE)
)


def _bound(port: int | None) -> socket.socket:
    """A socket that listens on a port, the first free one if None; LogError where it is taken."""
    for tried in range(PORT, PORT + TRIES) if port is None else ():
        with contextlib.suppress(OSError):
            return socket.create_server((LOCALHOST, tried))
    try:
        return socket.create_server((LOCALHOST, port or 0))
    except OSError as error:
        raise LogError(f"--port {port}: cannot be listened on, {reason(error)}; choose another one") from None
