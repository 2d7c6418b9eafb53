"""Attacks on the pages that a started program serves: strangers see nothing, and nobody but a signal ends it.

The program is a process as a user starts it, since what is printed by a thread at its end is seen by no other test.
`SUREFOOT_TRIALS` says how many requests and frames each gets.
"""

import contextlib
import os
import random
import re
import signal
import socket
import struct
import subprocess
import sys
import time
from pathlib import Path
from urllib.parse import urlsplit

import pytest
from strangers import ask, exchange, let_in, listening

import surefoot

pytestmark = pytest.mark.long

viser = pytest.importorskip("viser")
msgspec = pytest.importorskip("msgspec")
client = pytest.importorskip("websockets.sync.client")
exceptions = pytest.importorskip("websockets.exceptions")
zstandard = pytest.importorskip("zstandard")

TRIALS = int(os.environ.get("SUREFOOT_TRIALS", "2000"))
MOST = 1 << 30
"""Memory that a program may take [B]."""

CODES = {signal.SIGINT: 130, signal.SIGTERM: 143, signal.SIGHUP: 129}
NUMBERS = [float("nan"), float("inf"), -1e300, 2**63, True, None]
ODD = [*NUMBERS, "x", 400 * "9", 90_000 * "a", b"\xff", [], 5000 * [1], {}, {"a": 1}, [[1, 2, 3]], ["x", 0, 0]]
VECTOR = [0.0, 0.0, 1.0]
HONEST = (
    {"type": "ViewerCameraMessage", "wxyz": [1, 0, 0, 0], "position": VECTOR, "fov": 1.0, "near": 0.1, "far": 9.0}
    | {"image_height": 480, "image_width": 640, "look_at": VECTOR, "up_direction": VECTOR},
    {"type": "SceneNodeClickMessage", "name": "/Robot/torso/0", "instance_index": None, "ray_origin": VECTOR}
    | {"ray_direction": VECTOR, "screen_pos": [0, 0], "modifier": None},
    {"type": "FileTransferStartUpload", "source_component_uuid": "", "transfer_uuid": "t", "filename": "f"}
    | {"mime_type": "x", "part_count": 0, "size_bytes": 1 << 40},
    {"type": "GuiFormDirtyMessage", "uuid": "x"},
    {"type": "SceneNodeUpdateMessage", "name": "/Robot", "updates": {"visible": False}},
    {"type": "RemoveSceneNodeMessage", "name": "/Robot"},
    {"type": "GuiRemoveMessage", "uuid": ""},
)
ATTRIBUTES = ["value", "removed", "update_cb", "sync_cb", "is_button", "uuid", "props", "gui_api", "no_such"]


class Started:
    """A program that serves a page, and what it has said."""

    def __init__(self, folder: Path, *arguments: str) -> None:
        self.said, self.complaints = folder / "said.txt", folder / "complaints.txt"
        command = [sys.executable, "-m", "surefoot", *arguments]
        with self.said.open("w") as out, self.complaints.open("w") as err:
            self.process = subprocess.Popen(command, stdout=out, stderr=err, cwd=folder, start_new_session=True)
        self.address = self._address()

    def _address(self) -> str:
        end = time.monotonic() + 60
        while time.monotonic() < end and self.process.poll() is None:
            if found := re.search(r"http://\S+/(?= )", self.said.read_text() + self.complaints.read_text()):
                return found[0]
            time.sleep(0.05)
        raise AssertionError(self.complaints.read_text())

    def server(self) -> int:
        """The process that serves: its own, or that of the replay beside a run."""
        port = urlsplit(self.address).port
        family = [self.process.pid, *children(self.process.pid)]
        (found,) = [number for number in family if port in {at for _, at in listening(number)}]
        return found

    def memory(self) -> int:
        """The most that the serving process has had [B]."""
        text = Path(f"/proc/{self.server()}/status").read_text()
        return 1024 * int(re.search(r"VmHWM:\s+(\d+)", text)[1])

    def end(self, number: int) -> int:
        """Exit code after a signal, which no client may hold back."""
        self.process.send_signal(number)
        return self.process.wait(15)


def children(process: int) -> list[int]:
    return [int(word) for word in Path(f"/proc/{process}/task/{process}/children").read_text().split()]


@pytest.fixture(scope="module")
def log(tmp_path_factory):
    return surefoot.run(surefoot.load("stand", {"duration": 2.0}), out=tmp_path_factory.mktemp("run")).log


@pytest.fixture(params=["replay", "view"])
def started(request, log, tmp_path):
    replay = ["replay", str(log), "--live"]
    # An hour of standing: the run shall be ended by a signal, whatever else happens.
    view = ["run", "stand", "--set", "duration=3600", "--view", "--out", str(tmp_path)]
    program = Started(tmp_path, *(replay if request.param == "replay" else view))
    yield program
    with contextlib.suppress(ProcessLookupError):
        os.killpg(program.process.pid, signal.SIGKILL)


def connected(address: str):
    subprotocols = [f"viser-v{viser.__version__}"]
    return client.connect(address.replace("http", "ws"), subprotocols=subprotocols, max_size=None, ping_interval=None)


def opened(address: str) -> socket.socket:
    return socket.create_connection((urlsplit(address).hostname, urlsplit(address).port), timeout=10)


def reset(connection: socket.socket) -> None:
    """Have a connection end without a farewell."""
    connection.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, struct.pack("ii", 1, 0))
    connection.close()


def controls(address: str) -> list[str]:
    """Names of the viewer's controls, as it tells each page."""
    found: list[str] = []
    with connected(address) as page, contextlib.suppress(TimeoutError):
        while len(found) < 10:
            window = page.recv(timeout=5)
            size = int.from_bytes(window[8:16], "little")
            told = msgspec.msgpack.decode(zstandard.decompress(window[16 : 16 + size]))["messages"]
            found += [m["uuid"] for m in told if m["type"].startswith("Gui") and len(m.get("uuid", "")) > 20]
    assert len(found) > 5
    return found


def strange(address: str) -> list[dict[str, str]]:
    """Headers that no page of this machine sends."""
    port = urlsplit(address).port
    names = [
        "evil.com",
        "127.0.0.1.evil.com",
        "localhost.evil.com",
        "127.0.0.1.nip.io",
        "0.0.0.0",
        "127.1",
        "2130706433",
    ]
    names += [
        "0x7f000001",
        "[::]",
        "[::ffff:127.0.0.1]",
        "127.0.0.2",
        "localhost.",
        "lоcalhost",
        "[::1",
        "::1",
        "",
        " ",
    ]
    names += ["localhost,evil.com", "localhost/evil.com", "localhost\\evil.com", "localhost#evil.com", "@localhost"]
    hosts = [{"Host": f"{name}{ending}"} for name in names for ending in ("", f":{port}", ":99999")]
    own = [f"127.0.0.1:{port}", f"LOCALHOST:{port}", f"[::1]:{port}"]
    others = [
        "http://evil.com",
        "HTTP://EVIL.COM",
        f"http://evil.com:{port}",
        "null",
        "",
        f"https://{own[0]}",
        "file://",
    ]
    others += [f"http://127.0.0.1:{port + 1}", f"http://{own[0]}.evil.com", f"http://{own[0]}@evil.com", "http://[::1"]
    others += [f"http://{own[0]}/", f"http://{own[0]} http://evil.com", "chrome-extension://x", "http://127.0.0.1"]
    return hosts + [{"Host": host, "Origin": origin} for host in own for origin in others if origin]


def below(chance: random.Random) -> str:
    """A path that leads nowhere."""
    steps = [
        "..",
        "%2e%2e",
        "%252e%252e",
        ".",
        "viewer",
        "etc",
        "passwd",
        "%00",
        "%ff",
        "assets",
        "\\..",
        "session",
        "~",
    ]
    return "/".join(chance.choice(steps) for _ in range(chance.randint(1, 9)))


def test_strangers_get_nothing_of_it(started):
    root, token = started.address[: started.address.index("/", 8)], urlsplit(started.address).path.strip("/")
    assert let_in(started.address) == []
    assert [given for given in strange(started.address) if ask(started.address, **given)[0] not in (0, 400, 403)] == []
    for given in strange(started.address):
        assert ask(started.address, "", True, **given)[0] in (0, 400, 403)
    for wrong in ("", token[:-1], f"{token}x", token.swapcase(), f"%{ord(token[0]):02x}{token[1:]}", f"x/../{token}"):
        assert ask(f"{root}/{wrong}/" if wrong else f"{root}/")[0] == 403
    for host in ("LOCALHOST", "LocalHost:1", "[::1]:8080", "127.0.0.1"):
        assert ask(started.address, Host=host)[0] == 200
    with pytest.raises(OSError):  # refused, or no such family
        socket.create_connection(("::1", urlsplit(started.address).port), timeout=5)
    chance = random.Random(40)
    for _ in range(TRIALS // 4):
        status, text = ask(started.address, below(chance))
        assert "root:" not in text
        assert status in (400, 403, 404) or "<title>" in text
    assert started.complaints.read_text().count("\n") <= 1


def frame(chance: random.Random, names: list[str]) -> bytes | str:
    """Something like a message of the viewer's page."""
    kind = chance.randrange(10)
    if kind == 0:
        return chance.choice(["", "text", b"", b"\xc1", 9000 * b"\x91", chance.randbytes(300), bytes(200_000)])
    message = dict(chance.choice(HONEST))
    if kind < 6:
        attribute = chance.choice(ATTRIBUTES)
        message = {"type": "GuiUpdateMessage", "uuid": chance.choice(names), "updates": {attribute: chance.choice(ODD)}}
        return msgspec.msgpack.encode(message)
    if kind < 9:
        message[chance.choice(sorted(message))] = chance.choice([*ODD, *names])
    return msgspec.msgpack.encode(message)


def flood(address: str, chance: random.Random, frames: int) -> None:
    """Send frames over many sockets, some of which are reset in the middle, and others read nothing."""
    names = [*controls(address), "x"]
    pages = []
    for _ in range(frames):
        if len(pages) < 40:
            pages.append(connected(address))
            pages[-1].send(msgspec.msgpack.encode(HONEST[0]))
        page = chance.choice(pages)
        try:
            page.send(frame(chance, names))
            if chance.random() < 0.02:
                reset(page.socket)
        except (exceptions.ConnectionClosed, OSError):
            pages.remove(page)


def requests(address: str, chance: random.Random, number: int) -> None:
    """Requests that are none, too long, cut off, or left alone."""
    path, host = urlsplit(address).path, urlsplit(address).netloc
    head = f"GET {path} HTTP/1.1\r\nHost: {host}\r\n"
    socketed = "Upgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Version: 13\r\nSec-WebSocket-Key: "
    parts = [
        head + "X: " + 1_000_000 * "a" + "\r\n\r\n",
        head + 5000 * "X: a\r\n" + "\r\n",
        head + f"Content-Length: {400 * '9'}\r\n\r\n" + 100_000 * "[",
        head + "Transfer-Encoding: chunked\r\n\r\n" + 400 * "f" + "\r\n",
        head + socketed + "x\r\n\r\n",
        head + socketed + "MDEyMzQ1Njc4OWFiY2RlZg==\r\n\r\n\x81\xff\xff\xff\xff\xff\xff\xff\xff\xff",
        head + socketed + "MDEyMzQ1Njc4OWFiY2RlZg==\r\n\r\n\x8f\x05hello",
        f"GET {path}{9000 * 'a'} HTTP/1.1\r\nHost: {host}\r\n\r\n",
        f"POST {path} HTTP/1.1\r\nHost: {host}\r\nContent-Length: 9999999\r\n\r\n" + 1_000_000 * '{"a":',
        "PRI * HTTP/2.0\r\n\r\nSM\r\n\r\n",
        "\x16\x03\x01\x02\x00\x01\x00\x01\xfc\x03\x03",
        "GET",
        "",
    ]
    for _ in range(number):
        sent = chance.choice(parts).encode("latin-1")
        sent = sent[: chance.randrange(len(sent) + 1)] if chance.random() < 0.3 else sent
        with contextlib.suppress(OSError), opened(address) as connection:
            connection.sendall(sent)
            if chance.random() < 0.5:
                reset(connection)


@pytest.mark.parametrize("number", CODES)
def test_a_flood_neither_ends_it_nor_is_heard_of_and_a_signal_does(started, number):
    chance, watched = random.Random(int(number)), started.complaints.read_text()
    half_open = [opened(started.address) for _ in range(40)]
    for index, connection in enumerate(half_open):
        connection.sendall([b"", b"GET", b"GET / HT", b"GET / HTTP/1.1\r\nHost:"][index % 4])
    slow = [connected(started.address) for _ in range(10)]
    requests(started.address, chance, TRIALS // 2)
    flood(started.address, chance, TRIALS // 2)
    time.sleep(0.5)
    assert ask(started.address)[0] == 200
    assert exchange(started.address, b"POST / HTTP/1.1\r\n\r\n").startswith("HTTP/1.1 405")
    assert started.process.poll() is None
    assert started.memory() < MOST
    served = started.server()
    assert started.end(number) == CODES[number]
    end = time.monotonic() + 5
    while Path(f"/proc/{served}").exists() and time.monotonic() < end:
        time.sleep(0.05)
    assert not Path(f"/proc/{served}").exists()
    said = started.complaints.read_text().removeprefix(watched)
    logs = list(started.complaints.parent.glob("*/log.mcap"))
    assert re.fullmatch(r"(interrupted; the log up to here is whole: .*\n)?", said)
    assert [surefoot.read(path).truncated for path in logs] in ([], [False])
    assert len(half_open) + len(slow) == 50
