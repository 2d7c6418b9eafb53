"""Only the page of the address that was said is answered, whatever is sent; nothing of it reaches the terminal."""

import random
import socket
import struct
import time
from collections.abc import Iterator

import pytest
from strangers import ask, exchange, let_in, listening

from surefoot.scenarios.errors import LogError
from surefoot.scenarios.log import Log
from surefoot.scenarios.show.replay.content import ReplayWindow
from surefoot.scenarios.show.replay.extract import extract
from surefoot.scenarios.show.replay.gate import LONGEST_MESSAGE, Gate, is_heard, is_here, serving
from surefoot.scenarios.show.replay.live import serve

pytestmark = pytest.mark.unit

viser = pytest.importorskip("viser")
msgspec = pytest.importorskip("msgspec")
client = pytest.importorskip("websockets.sync.client")


@pytest.fixture
def address() -> Iterator[str]:
    gate = Gate()
    with serving(gate):
        yield gate.address


def connected(address: str, **options):
    return client.connect(address.replace("http", "ws"), subprotocols=[f"viser-v{viser.__version__}"], **options)


def test_pages_of_others_and_names_pointed_here_are_refused_on_every_socket(address):
    assert let_in(address) == []
    assert ask(address)[0] == 200
    assert ask(address, Origin=address.removesuffix("/").rpartition("/")[0])[0] == 200
    assert ask(address, Host="localhost:9000", Origin="http://localhost:9000")[0] == 200  # through a tunnel
    with connected(address, origin=address.removesuffix("/").rpartition("/")[0]) as page:
        assert len(page.recv(timeout=10)) > 16
    with connected(address) as program:
        assert len(program.recv(timeout=10)) > 16


def test_a_refusal_says_what_would_be_right(address):
    assert "the whole address that the command has said" in ask(address[:-3])[1]
    assert "open 127.0.0.1" in ask(address, Host="evil.example")[1]
    answer = exchange(address, b"POST /input HTTP/1.1\r\nContent-Length: 9000\r\n\r\n" + 9000 * b"[")
    assert answer.startswith("HTTP/1.1 405")
    assert "through their websockets" in answer


@pytest.mark.parametrize(
    ("host", "here"),
    [
        ("127.0.0.1", True),
        ("127.0.0.1:80", True),
        ("LocalHost:9000", True),
        ("[::1]:8080", True),
        ("127.0.0.1:", True),
        ("127.0.0.1:80:80", False),
        ("127.0.0.1:80x", False),
        ("[::1]x:80", False),
        ("::1", False),
        ("127.0.0.1:٨٠", False),
        ("127.0.0.1 ", False),
        ("a@127.0.0.1", False),
        ("127.0.0.1.evil.example", False),
        ("127.0.0.1/x", False),
        ("", False),
    ],
)
def test_a_host_is_this_machine_or_it_is_not(host, here):
    assert is_here(host) == here


def test_a_host_with_two_ports_is_not_answered(address):
    assert "open 127.0.0.1" in ask(address, Host="127.0.0.1:80:80")[1]


def test_a_live_view_is_behind_the_gate_and_on_one_port(log_path):
    before, seen = listening(), []

    def say(text: str) -> None:
        address = text.split()[0]
        seen.append(([port for port in listening() if port not in before], let_in(address), ask(address)[0]))
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        serve(log_path, ReplayWindow(), say)
    ((ports, strangers, own),) = seen
    assert (len(ports), strangers, own) == (1, [], 200)


def test_a_recorder_listens_nowhere():
    before = listening()
    with serving() as server:
        assert listening() == before
        with pytest.raises(ConnectionRefusedError):
            socket.create_connection(("127.0.0.1", server.get_port()), timeout=5)


def test_a_viser_that_cannot_be_guarded_is_not_used(monkeypatch):
    stopped = []

    class Server:
        def __init__(self, **_: object) -> None:
            pass

        def stop(self) -> None:
            stopped.append(True)

    monkeypatch.setattr(viser, "ViserServer", Server)
    with pytest.raises(LogError, match="cannot be guarded from other pages"), serving(Gate()):
        pass
    assert stopped


def test_a_port_that_is_taken_is_told_of():
    with socket.socket() as other:
        other.bind(("127.0.0.1", 0))
        other.listen()
        port = other.getsockname()[1]
        with pytest.raises(LogError, match=f"--port {port}: cannot be listened on"), serving(Gate(port)):
            pass


def packed(**message: object) -> bytes:
    return bytes(msgspec.msgpack.encode(message))


HANDS = {"ray_origin": [0, 0, 0], "ray_direction": "up", "screen_pos": [0, 0], "instance_index": None, "modifier": None}
FRAMES = (
    "text",
    b"",
    b"\xc1",
    b"\x91" * 5000,
    packed(type="NoSuchMessage"),
    packed(type="ViewerCameraMessage"),
    packed(type="SceneNodeClickMessage", name="/Robot/torso/0", **HANDS),
    packed(type="GuiUpdateMessage", uuid="x", updates={"value": "nan"}),
    packed(kind="nothing"),
    b"\x00" * (LONGEST_MESSAGE + 1),
)


@pytest.mark.parametrize(
    ("heard", "message"),
    [
        (True, packed(type="GuiUpdateMessage", uuid="x", updates={"value": 0.5})),
        (True, packed(type="SceneNodeClickMessage", name="/Robot/torso/0", **HANDS)),
        (False, packed(type="GuiUpdateMessage", uuid="x", updates={"update_cb": 7})),
        (False, packed(type="GuiUpdateMessage", uuid="x", updates={"value": 1.0, "removed": True})),
        (False, packed(type="GuiUpdateMessage", uuid="x", updates={"value": [1.0]})),
        (False, packed(type="GuiUpdateMessage", uuid="x", updates=None)),
        (False, packed(type="ShareUrlRequest")),
        (False, packed(type="FileTransferStartUpload", part_count=0)),
        (False, packed(type=["GuiUpdateMessage"])),
        (False, packed(kind="nothing")),
        *((False, frame) for frame in ("text", b"", b"\xc1", b"\x91" * 90_000)),
    ],
)
def test_viser_hears_what_the_pages_send_and_no_more(heard, message):
    assert is_heard(message) is heard


def test_a_message_that_names_an_attribute_of_a_control_does_not_reach_it():
    gate = Gate()
    with serving(gate) as server:
        slider = server.gui.add_slider("x", min=0.0, max=1.0, step=0.1, initial_value=0.0)
        with connected(gate.address) as page:
            page.send(packed(type="GuiUpdateMessage", uuid=slider._impl.uuid, updates={"update_cb": 7}))
            page.send(packed(type="GuiUpdateMessage", uuid=slider._impl.uuid, updates={"value": 0.5}))
            end = time.monotonic() + 10
            while slider.value != 0.5 and time.monotonic() < end:
                time.sleep(0.01)
        slider.value = 0.7  # calls what is called on an update
        assert slider.value == 0.7


def test_a_connection_that_says_nothing_does_not_hold_back_the_end():
    gate = Gate()
    with serving(gate):
        half_open = socket.create_connection(("127.0.0.1", int(gate.address.split(":")[2].split("/")[0])))
        half_open.sendall(b"GET / HT")
        time.sleep(0.2)
        begin = time.monotonic()
    assert time.monotonic() - begin < 4.0  # viser waits for 6 s
    half_open.close()


def test_a_log_that_is_there_no_more_is_told_of(log_path, tmp_path):
    path = tmp_path / "log.mcap"
    path.write_bytes(log_path.read_bytes())
    with pytest.raises(LogError, match=r"cannot be followed any more, .*leave it where it is"):
        serve(path, ReplayWindow(), lambda _: path.unlink())


def noise(chance: random.Random, address: str) -> bytes:
    """Bytes like a request: of a stranger, cut off, or of nothing at all."""
    path, host = address[address.index("/", 8) :], address.split("/")[2]
    paths = [
        path,
        path[:-1],
        "/",
        "//",
        "*",
        "http://x/",
        f"{path}viewer",
        f"{path}../",
        "/%2e%2e/",
        9000 * "a",
        "/\xff",
    ]
    names = ["Host", "Origin", "Upgrade", "Connection", "Content-Length", "Transfer-Encoding", "Sec-WebSocket-Key", ":"]
    values = [
        host,
        "evil.example",
        "null",
        "websocket",
        "Upgrade",
        "-1",
        "chunked",
        "\x00",
        "[::1",
        "a@b:c:d",
        9000 * "b",
    ]
    methods, versions = ["GET", "GET", "POST", "PUT", "get", ""], ["1.1", "1.1", "1.0", "9"]
    lines = [f"{chance.choice(methods)} {chance.choice(paths)} HTTP/{chance.choice(versions)}"]
    lines += [f"{chance.choice(names)}: {chance.choice(values)}" for _ in range(chance.randrange(6))]
    text = "\r\n".join([*lines, "", ""]).encode("latin-1") + chance.randbytes(chance.choice([0, 0, 9000]))
    return chance.choice([text, text[: chance.randrange(len(text))], chance.randbytes(chance.randrange(300))])


@pytest.mark.parametrize("requests", [200, pytest.param(20_000, marks=pytest.mark.long)], ids=["slice", "whole"])
def test_bad_frames_and_noise_leave_the_terminal_alone_and_the_page_open(recwarn, address, capfd, requests):
    chance = random.Random(28)
    host = ("127.0.0.1", int(address.split(":")[2].split("/")[0]))
    half_open = [socket.create_connection(host) for _ in range(30)]
    for number, connection in enumerate(half_open):
        connection.sendall([b"", b"GET", b"GET / HT", b"GET / HTTP/1.1\r\nHost:"][number % 4])
    for frame in FRAMES:
        with connected(address) as page:
            page.send(frame)
            page.recv(timeout=10)
    old = client.connect(address.replace("http", "ws"))
    with old, pytest.raises(Exception, match="another version of viser"):
        old.recv(timeout=10)
    for _ in range(requests):
        with socket.create_connection(host) as connection:
            connection.sendall(noise(chance, address))
            if chance.random() < 0.5:  # a reset instead of an end
                connection.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, struct.pack("ii", 1, 0))
    assert ask(address)[0] == 200
    for connection in half_open:
        connection.close()
    time.sleep(0.3)
    captured = capfd.readouterr()
    assert (captured.out, captured.err, recwarn.list) == ("", "", [])


def test_what_a_page_sends_does_not_end_a_live_view(log: Log):
    from types import SimpleNamespace

    from surefoot.scenarios.show.replay.live import Player

    with serving() as server:
        player = Player(server, extract(log))
        player._sought(SimpleNamespace(client=object(), target=SimpleNamespace(value=float("nan"))))
        player._speed.value = "much"
        player.advance(time.monotonic() + 0.1)
        assert player._slider.value == pytest.approx(0.1, abs=0.05)
