"""Requests as a page of others, a name that others point here, or a program without the token would send them."""

import re
import socket
from collections.abc import Mapping
from pathlib import Path
from urllib.parse import urlsplit

KEY = {"Upgrade": "websocket", "Connection": "Upgrade", "Sec-WebSocket-Version": "13"}
KEY |= {"Sec-WebSocket-Key": "MDEyMzQ1Njc4OWFiY2RlZg==", "Sec-WebSocket-Protocol": "viser-v1.1.1"}


def ask(address: str, below: str = "", upgrade: bool = False, **headers: str | None) -> tuple[int, str]:
    """Status and body of the answer to a GET; headers of None are left out."""
    parts = urlsplit(address)
    given: dict[str, str | None] = {"Host": parts.netloc, **(KEY if upgrade else {}), **headers}
    lines = [f"GET {parts.path}{below} HTTP/1.1", *(f"{name}: {value}" for name, value in given.items() if value)]
    answer = exchange(address, "\r\n".join([*lines, "", ""]).encode(), whole=not upgrade)
    status = re.match(r"HTTP/1.1 (\d{3})", answer)
    return int(status[1]) if status else 0, answer.partition("\r\n\r\n")[2]


def exchange(address: str, sent: bytes, whole: bool = True) -> str:
    """Answer to bytes, up to the end of the connection or only at first."""
    parts, answer = urlsplit(address), b""
    with socket.create_connection((parts.hostname, parts.port), timeout=10) as connection:
        connection.sendall(sent)
        while part := connection.recv(1 << 16):
            answer += part
            if not whole:
                break
    return answer.decode(errors="replace")


def foreign(address: str) -> Mapping[str, Mapping[str, str | None]]:
    """Headers of strangers, by what they are."""
    here = urlsplit(address)
    return {
        "a page of others": {"Origin": "http://evil.example"},
        "a page of another port": {"Origin": f"http://{here.hostname}:{here.port + 1}"},
        "a page without an origin": {"Origin": "null"},
        "a page that calls itself https": {"Origin": f"https://{here.netloc}"},
        "a name pointed here": {"Host": f"evil.example:{here.port}"},
        "such a name with its page": {
            "Host": f"evil.example:{here.port}",
            "Origin": f"http://evil.example:{here.port}",
        },
        "a name that ends well": {"Host": "evil.localhost"},
        "a user's name": {"Host": f"localhost@evil.example:{here.port}"},
        "no host": {"Host": None},
    }


def let_in(address: str, *sockets: str) -> list[str]:
    """Strangers who are answered by a page or by its sockets: none, it is hoped."""
    root = f"{address[: address.index('/', 8)]}/"
    strangers = [(name, address, headers) for name, headers in foreign(address).items()]
    tokens = {"no token": root, "another token": f"{root}{'a' * 22}/", "a part of it": f"{address[:-2]}/"}
    strangers += [(name, wrong, {}) for name, wrong in tokens.items()]
    found = []
    for name, to, headers in strangers:
        for below, upgrade in [("", False), ("viewer", False), *((below, True) for below in ("", *sockets))]:
            status, _ = ask(to, below, upgrade, **headers)
            if status != 403:
                found.append(f"{name}: {below or 'the page'}{' as a socket' * upgrade} answers {status}")
    return found


def listening(process: int | None = None) -> list[tuple[str, int]]:
    """Addresses (as the kernel writes them) and ports that a process listens on, this one if None."""
    folder = Path("/proc") / str(process or "self")
    own = {str(link.readlink()) for link in (folder / "fd").iterdir() if link.is_symlink()}
    rows = [line.split() for name in ("tcp", "tcp6") for line in (folder / "net" / name).read_text().splitlines()[1:]]
    places = [row[1].rpartition(":") for row in rows if row[3] == "0A" and f"socket:[{row[9]}]" in own]
    return [(host, int(port, 16)) for host, _, port in places]
