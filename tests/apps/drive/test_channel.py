"""Input of a page is taken in order or refused in a sentence; news are sent as fast as the page draws."""

import json
import random
import threading
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from strangers import ask, let_in, listening

import surefoot
from surefoot.apps.drive.channel import DRAWN, LONGEST_INPUT, PageChannel, read_object
from surefoot.apps.drive.command import drive_scenario
from surefoot.apps.drive.page import CHANNEL, GREATEST_IMPULSE, DrivePage, opened
from surefoot.apps.drive.session import MOST_WAITING, Inputs, PaceInput, Reset
from surefoot.planner.types import Twist
from surefoot.scenarios.show.replay.gate import Gate, serving

pytestmark = pytest.mark.unit

pytest.importorskip("viser")
client = pytest.importorskip("websockets.sync.client")


class Served:
    def __init__(self) -> None:
        self.taken: list[Any] = []
        self.left = threading.Event()
        self.channel = PageChannel(self._take, self.left.set)
        self.gate = Gate(sockets={"here": self.channel.serve})

    def _take(self, given: Any) -> None:
        if given["kind"] == "nonsense":
            raise ValueError("that is nonsense")
        self.taken.append(given["kind"])

    def connected(self) -> Any:
        return client.connect(f"{self.gate.address.replace('http', 'ws')}here")


@pytest.fixture
def served() -> Iterator[Served]:
    made = Served()
    with serving(made.gate):
        yield made


def sent(socket: Any, kind: str) -> None:
    socket.send(json.dumps({"kind": kind}))


def eventually(true: Any) -> bool:
    end = time.monotonic() + 10
    while not true() and time.monotonic() < end:
        time.sleep(0.01)
    return bool(true())


def test_inputs_are_taken_in_order_and_a_refusal_is_told(served: Served) -> None:
    with served.connected() as page:
        for kind in ("a", "b", "nonsense", "c"):
            sent(page, kind)
        assert json.loads(page.recv(timeout=10)) == {"refused": "that is nonsense"}
        assert not served.channel.drawn  # it has sent, but drawn nothing
        assert eventually(lambda: served.taken == ["a", "b", "c"])
        assert not served.left.is_set()
    assert served.left.wait(10)


def test_news_are_told_as_fast_as_a_page_draws_them(served: Served) -> None:
    assert not served.channel.drawn  # nobody looks
    served.channel.tell("first")
    with served.connected() as page:
        assert page.recv(timeout=10) == "first"
        for text in ("missed", "missed, too", "newest"):
            served.channel.tell(text)
        assert not served.channel.drawn
        with pytest.raises(TimeoutError):
            page.recv(timeout=0.3)
        sent(page, DRAWN)
        assert page.recv(timeout=10) == "newest"
        assert not served.channel.drawn
        sent(page, DRAWN)
        assert eventually(lambda: served.channel.drawn)
        served.channel.tell("soon")
        assert page.recv(timeout=10) == "soon"
        served.channel.tell("in any case")
        assert page.recv(timeout=10) == "in any case"  # a page that says nothing is waited for in vain
        sent(page, DRAWN)
        assert eventually(lambda: served.channel.drawn)
        with served.connected() as program:
            assert program.recv(timeout=10) == "in any case"
            assert served.channel.drawn  # it keeps no page waiting


@pytest.mark.parametrize(
    "given",
    [
        9000 * "[",
        9000 * '{"a":',
        '{"kind": "reset", "a": ' + 9000 * "1" + "}",
        '{"kind": "pace", "speed": NaN}',
        '{"kind": "pace", "speed": -Infinity}',
        "[]",
        "3",
        "null",
        "",
        '{"kind":',
        b'{"kind": "reset"}',
        '{"kind": "reset", "a": "' + LONGEST_INPUT * "x" + '"}',
    ],
)
def test_what_is_no_input_is_refused_in_a_sentence(given: str | bytes) -> None:
    with pytest.raises(ValueError, match="an input is ") as refused:
        read_object(given)
    assert len(str(refused.value)) < 120


@pytest.fixture
def page() -> Iterator[tuple[DrivePage, Inputs]]:
    inputs = Inputs()
    with opened(None, inputs) as made:
        yield made, inputs


def test_every_bad_input_gets_an_answer_and_none_acts(page: tuple[DrivePage, Inputs], capfd: Any) -> None:
    made, inputs = page
    bad = [
        '{"kind": "pace", "paused": "x"}',
        '{"kind": "pace", "paused": 0}',
        '{"kind": "click", "impulse": -5}',
        '{"kind": "click", "impulse": 0}',
        '{"kind": "click", "impulse": 1e999}',
        '{"kind": "click", "impulse": %s}' % (400 * "9"),
        '{"kind": "velocity", "v_x": %s, "v_y": 0, "yaw_rate": 0}' % (400 * "9"),
        '{"kind": "camera", "follows": "no"}',
        '{"kind": "camera"}',
        '{"kind": "layer", "layer": ["Robot"], "shown": true}',
        '{"kind": "layer", "layer": "Robot", "shown": 1}',
        '{"kind": "shadows", "shown": null}',
        '{"kind": ["reset"]}',
        '{"kind": "%s"}' % (5000 * "x"),
        9000 * "[",
    ]
    address = f"{made.address.replace('http', 'ws')}{CHANNEL}"
    with client.connect(address) as socket:
        for text in bad:
            socket.send(text)
            refused = json.loads(socket.recv(timeout=10))["refused"]
            assert 5 < len(refused) < 150
            assert "\n" not in refused
        socket.send('{"kind": "reset"}')
        assert eventually(lambda: not inputs.empty())
        assert inputs.get() == Reset()
    assert inputs.get(timeout=10) == Twist()  # who leaves, stops it
    assert capfd.readouterr() == ("", "")


def test_more_inputs_than_may_wait_are_refused_and_a_stop_never_is(page: tuple[DrivePage, Inputs]) -> None:
    made, inputs = page
    with client.connect(f"{made.address.replace('http', 'ws')}{CHANNEL}") as socket:
        for _ in range(MOST_WAITING + 1):
            socket.send('{"kind": "gait", "swing_height": 0.05}')
        refused = json.loads(socket.recv(timeout=10))["refused"]
        assert refused == "1000 inputs wait to be taken; send fewer at once"
        for _ in range(50):
            socket.send('{"kind": "velocity", "v_x": 0.1, "v_y": 0, "yaw_rate": 0}')
            socket.send('{"kind": "reset"}')
    assert eventually(lambda: inputs.queue[-1] == Twist())  # who leaves, stops it
    waiting = [inputs.get() for _ in range(inputs.qsize())]
    assert len(waiting) == MOST_WAITING + 2
    assert waiting[-2:] == [Reset(), Twist()]


def test_it_has_been_looked_at_once_a_page_was_open(page: tuple[DrivePage, Inputs]) -> None:
    made, _ = page
    assert not made.looked_at
    with client.connect(f"{made.address.replace('http', 'ws')}{CHANNEL}"):
        assert eventually(lambda: made.looked_at)
    assert made.looked_at


def mutated(chance: random.Random) -> str:
    """Something like an input."""
    values = [
        "1",
        "-1e300",
        "1e999",
        "true",
        "null",
        '"x"',
        "[1]",
        "{}",
        400 * "7",
        30 * "[",
        "NaN",
        '"\\ud800"',
        "0.3",
    ]
    keys = ["v_x", "v_y", "yaw_rate", "speed", "paused", "impulse", "follows", "layer", "shown", "swing_height", "kind"]
    kinds = ["velocity", "gait", "pace", "click", "camera", "layer", "shadows", "drawn", "jump"]
    rest = "".join(f', "{chance.choice(keys)}": {chance.choice(values)}' for _ in range(chance.randrange(5)))
    text = f'{{"kind": "{chance.choice(kinds)}"{rest}}}'
    cut = chance.randrange(len(text)) if chance.random() < 0.2 else len(text)
    return text[:cut]


def attack(made: DrivePage, inputs: Inputs, sockets: int, requests: int, seed: int) -> None:
    """Send inputs like honest ones on many sockets; each is taken or answered, and what is taken may be asked for."""
    chance, address = random.Random(seed), f"{made.address.replace('http', 'ws')}{CHANNEL}"
    pages = [client.connect(address) for _ in range(sockets)]
    for _ in range(requests):
        chance.choice(pages).send(mutated(chance))
    for socket in pages:
        socket.send('{"kind": "last"}')
        while "last" not in json.loads(socket.recv(timeout=60))["refused"]:
            pass
        socket.close()
    while not inputs.empty():
        given = inputs.get()
        if isinstance(given, PaceInput):
            assert given.paused in (None, True, False)
            assert given.speed is None or 0.1 <= given.speed <= 1.0
        if isinstance(given, Twist):
            assert abs(given.x) <= 0.6
    assert made._impulse is None or 0.0 < made._impulse <= GREATEST_IMPULSE


@pytest.mark.parametrize(
    ("sockets", "requests"), [(3, 500), pytest.param(30, 20_000, marks=[pytest.mark.long])], ids=["slice", "whole"]
)
def test_an_attack_on_the_page(page: tuple[DrivePage, Inputs], capfd: Any, sockets: int, requests: int) -> None:
    attack(*page, sockets, requests, seed=28)
    assert ask(page[0].address)[0] == 200
    assert capfd.readouterr() == ("", "")


def test_a_drive_is_behind_the_gate_and_on_one_port(tmp_path: Path) -> None:
    before, seen = listening(), []

    def say(text: str) -> None:
        address = text.split()[0]
        seen.append(([port for port in listening() if port not in before], let_in(address, CHANNEL), ask(address)[0]))
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        drive_scenario(surefoot.load("stand"), tmp_path, None, say)
    ((ports, strangers, own),) = seen
    assert (len(ports), strangers, own) == (1, [], 200)
