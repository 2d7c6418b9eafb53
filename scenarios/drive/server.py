"""The page's way to the session: a small HTTP server for this machine alone, which needs nothing but the library."""

import contextlib
import threading
from collections.abc import Callable, Iterator
from http import HTTPStatus
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer

from surefoot.scenarios.errors import LogError
from surefoot.scenarios.output import reason
from surefoot.scenarios.show.replay.scene import LOCALHOST, PORT

LONGEST_INPUT = 10_000
"""Bytes of an input; no honest one is longer."""

TRIES = 50
"""Ports that are tried when none was asked for."""

_SILENCE = 2.0
"""After so long without anything new the last state is told again, which also shows who is gone [s]."""


class PageServer:
    """Serves one page, takes what it sends, and tells it what is new.

    Args:
        port: to listen on; the first free one from 8080 on if None.
        take: is given the text of each input, on a thread of its own; a ValueError refuses it.
        left: is called when nobody looks at the page any more.

    Attributes:
        address: of the page.
        page: what is served; set before the address is told to anyone.
        take: is given the text of each input.

    Raises:
        LogError: the port is taken.
    """

    def __init__(self, port: int | None, take: Callable[[str], None], left: Callable[[], None]) -> None:
        self.page, self.take, self._left = "", take, left
        self._news, self._number, self._text = threading.Condition(), 0, ""
        self._watching, self._open = 0, True
        self._server = _bound(port, self)
        self.address = f"http://{LOCALHOST}:{self._server.server_address[1]}"
        self._thread = threading.Thread(target=self._server.serve_forever, args=(0.1,), daemon=True)
        self._thread.start()

    @property
    def port(self) -> int:
        """Where it listens."""
        return int(self._server.server_address[1])

    def tell(self, text: str) -> None:
        """Tell all who look at the page; who is too slow for it misses some."""
        with self._news:
            self._number, self._text = self._number + 1, text
            self._news.notify_all()

    def close(self) -> None:
        """Stop serving."""
        with self._news:
            self._open = False
            self._news.notify_all()
        self._server.shutdown()
        self._server.server_close()
        self._thread.join()

    def events(self) -> Iterator[str]:
        """What is new, as long as the server is open."""
        seen = -1
        while True:
            with self._news:
                if self._number == seen and self._open:
                    self._news.wait(_SILENCE)
                if not self._open:
                    return
                seen, text = self._number, self._text
            yield text

    def watched(self, by: int) -> None:
        """Count those who look at the page, one more or one less."""
        with self._news:
            self._watching += by
            nobody = self._watching == 0
        if nobody:
            self._left()


class _Handler(BaseHTTPRequestHandler):
    server: "_Server"
    protocol_version = "HTTP/1.1"
    timeout = 30.0

    def log_message(self, *_: object) -> None:
        """Say nothing."""

    def do_GET(self) -> None:
        if not self._own():
            return
        path = self.path.partition("?")[0]
        if path == "/":
            self._answer(HTTPStatus.OK, self.server.pages.page.encode(), "text/html; charset=utf-8")
        elif path == "/events":
            self._stream()
        else:
            self._answer(HTTPStatus.NOT_FOUND)

    def do_POST(self) -> None:
        length = self.headers.get("Content-Length", "")
        if not (length.isdecimal() and int(length) <= LONGEST_INPUT):
            self.close_connection = True
            self._answer(HTTPStatus.REQUEST_ENTITY_TOO_LARGE)
            return
        body = self.rfile.read(int(length))
        if not self._own():
            return
        try:
            self.server.pages.take(body.decode())
        except ValueError as refusal:  # a wrong encoding is one, too
            self._answer(HTTPStatus.BAD_REQUEST, str(refusal).encode(), "text/plain; charset=utf-8")
        else:
            self._answer(HTTPStatus.NO_CONTENT)

    def _own(self) -> bool:
        """Refuse what pages of others ask for, which a browser would let through to this machine."""
        hosts = [f"{name}:{self.server.pages.port}" for name in (LOCALHOST, "localhost")]
        origin = self.headers.get("Origin")
        if self.headers.get("Host") in hosts and (origin is None or origin.removeprefix("http://") in hosts):
            return True
        self._answer(HTTPStatus.FORBIDDEN)
        return False

    def _answer(self, status: HTTPStatus, content: bytes = b"", kind: str = "") -> None:
        self.send_response(status)
        if kind:
            self.send_header("Content-Type", kind)
            self.send_header("Cache-Control", "no-store")
        if status is not HTTPStatus.NO_CONTENT:
            self.send_header("Content-Length", str(len(content)))
        self.end_headers()
        self.wfile.write(content)

    def _stream(self) -> None:
        self.close_connection = True
        self.send_response(HTTPStatus.OK)
        self.send_header("Content-Type", "text/event-stream")
        self.send_header("Cache-Control", "no-store")
        self.end_headers()
        self.server.pages.watched(1)
        try:
            for text in self.server.pages.events():
                self.wfile.write(f"data: {text}\n\n".encode())
        except OSError:
            pass
        finally:
            self.server.pages.watched(-1)


class _Server(ThreadingHTTPServer):
    daemon_threads = True
    block_on_close = False

    def __init__(self, port: int, pages: PageServer) -> None:
        super().__init__((LOCALHOST, port), _Handler)
        self.pages = pages

    def handle_error(self, *_: object) -> None:
        """Say nothing of a browser that has closed a connection."""


def _bound(port: int | None, pages: PageServer) -> _Server:
    """A server on a port.

    Raises:
        LogError: it is taken.
    """
    for tried in range(PORT, PORT + TRIES) if port is None else ():
        with contextlib.suppress(OSError):
            return _Server(tried, pages)
    try:
        return _Server(port or 0, pages)
    except OSError as error:
        raise LogError(f"--port {port}: cannot be listened on, {reason(error)}; choose another one") from None
