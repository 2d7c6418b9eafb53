"""The door of a plant: one controller of this robot is let in, strangers are refused in a sentence."""

import socket
import time

import pytest

from surefoot.apps.bridge import door as doors
from surefoot.apps.bridge.door import Door
from surefoot.apps.bridge.frames import FrameReader, Kind, packed
from surefoot.apps.bridge.messages import end_bytes, json_bytes, json_of, why_of
from surefoot.scenarios.errors import LinkError

pytestmark = pytest.mark.unit

HELLO = packed(Kind.HELLO, json_bytes({"robot": "g1"}))


class Entrance:
    """A door, and what it has said."""

    def __init__(self, patience=doors.PATIENCE):
        self.said = []
        self.door = Door("127.0.0.1", 0, self.examine, {"robot": "g1"}, self.said.append, patience)

    def examine(self, hello):
        return "" if hello.get("robot") == "g1" else "a controller of another robot"

    def come(self, *sent):
        host, port = self.door.address.split(":")
        connection = socket.create_connection((host, int(port)), timeout=5.0)
        for part in sent:
            connection.sendall(part)
        return connection

    def hear(self, connection):
        """The first frame that is said to somebody; None if there is none."""
        reader = FrameReader()
        while (frame := reader.take()) is None:
            try:
                data = connection.recv(1 << 16)
            except ConnectionError:
                return None
            if not data:
                return None
            reader.feed(data)
        return frame

    def told(self):
        deadline = time.monotonic() + 5.0
        while not self.said and time.monotonic() < deadline:
            time.sleep(0.01)
        return self.said


@pytest.fixture(name="entrance")
def entrance_fixture():
    entrance = Entrance()
    yield entrance
    entrance.door.close()


def test_a_controller_is_let_in_and_may_speak_at_once(entrance):
    with entrance.come(HELLO + packed(Kind.END, b"{}")) as connection:
        frame = entrance.hear(connection)
        assert (frame.kind, json_of(frame.payload, "welcome")) == (Kind.WELCOME, {"robot": "g1"})
        guest = entrance.door.guests.get(timeout=5.0)
        assert guest.receive(1.0).kind is Kind.END
        guest.close()
    assert entrance.said == []


STRANGERS = {
    "a browser": (b"GET / HTTP/1.1\r\nHost: x\r\n\r\n", "begins with b'GET / HT' and is no message of surefoot"),
    "garbage": (bytes(range(7, 200)), "is no message of surefoot"),
    "another version": (HELLO[:4] + b"\7" + HELLO[5:], "a message of protocol 7 where 1 is spoken"),
    "one who is too long": (HELLO[:8] + b"\xff\xff\xff\x00" + HELLO[12:], "a message of 16777215 bytes"),
    "a wrong checksum": (HELLO[:-1] + b"!", "whose checksum is wrong"),
    "another robot": (packed(Kind.HELLO, json_bytes({"robot": "talos"})), "a controller of another robot"),
    "no greeting": (packed(Kind.HELLO, b"[1]"), "a greeting that is no object of JSON"),
    "a command first": (packed(Kind.COMMAND, bytes(40)), "a message COMMAND before it has said who it is"),
}


@pytest.mark.parametrize("who", STRANGERS)
def test_a_stranger_is_told_why_and_a_controller_is_let_in_after(entrance, who):
    sent, why = STRANGERS[who]
    with entrance.come(sent) as connection:
        frame = entrance.hear(connection)
        if frame is not None:  # an end with bytes unread may overtake the answer
            assert frame.kind is Kind.REFUSED
            assert why in why_of(frame.payload)
    (sentence,) = entrance.told()
    assert sentence.startswith("refused 127.0.0.1:")
    assert why in sentence
    with entrance.come(HELLO) as connection:
        assert entrance.hear(connection).kind is Kind.WELCOME


def test_a_second_controller_is_refused_and_the_first_goes_on(entrance):
    with entrance.come(HELLO) as first:
        assert entrance.hear(first).kind is Kind.WELCOME
        guest = entrance.door.guests.get(timeout=5.0)
        with entrance.come(HELLO) as second:
            assert "is walked by 127.0.0.1:" in why_of(entrance.hear(second).payload)
        guest.send(Kind.STATE, b"abc", 1.0)
        assert entrance.hear(first).payload == b"abc"
        assert entrance.door.guests.empty()
        guest.close()


def test_one_who_says_nothing_is_sent_away():
    entrance = Entrance(patience=0.1)
    with entrance.come(HELLO[:9]) as slow, entrance.come(HELLO) as quick:
        assert entrance.hear(quick).kind is Kind.WELCOME
        assert "has not said who it is in 0.1 s" in why_of(entrance.hear(slow).payload)
    entrance.door.close()


def test_a_crowd_is_not_waited_for(entrance):
    crowd = [entrance.come() for _ in range(3 * doors.MOST_WAITING)]
    sent_away = sum(entrance.hear(one) is not None for one in crowd[doors.MOST_WAITING :])
    assert sent_away == 2 * doors.MOST_WAITING
    assert len(entrance.said) <= doors.MOST_REFUSALS
    for one in crowd:
        one.close()
    time.sleep(0.1)
    with entrance.come(HELLO) as connection:
        assert entrance.hear(connection).kind is Kind.WELCOME


def test_it_listens_on_the_loopback_and_at_a_port_that_is_free(entrance):
    host, port = entrance.door.address.split(":")
    assert host == "127.0.0.1"
    with pytest.raises(LinkError, match=f"127.0.0.1:{port} cannot be served at, .*; choose another --port"):
        Door(host, int(port), entrance.examine, {}, entrance.said.append)


def test_why_is_a_message():
    assert why_of(end_bytes("over")) == "over"
