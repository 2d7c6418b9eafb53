"""Frames: what is sent arrives, in pieces of any size; nothing else is taken for a message."""

import socket
import time

import numpy as np
import pytest

from surefoot.apps.bridge.frames import MAGIC, FrameReader, Kind, Link, connected, packed, parsed
from surefoot.scenarios.errors import LinkError

pytestmark = pytest.mark.unit

SENT = [(Kind.HELLO, b"{}"), (Kind.STATE, bytes(range(256)) * 9), (Kind.END, b"")]


@pytest.fixture(name="pair")
def pair_fixture():
    with socket.create_server(("127.0.0.1", 0)) as listener:
        mine = socket.create_connection(listener.getsockname())
        theirs, _ = listener.accept()
    with mine, theirs:
        yield Link(mine), theirs


@pytest.mark.parametrize("size", [1, 7, 16, 4096])
def test_frames_come_whole_whatever_the_pieces(size):
    reader, wire, taken = FrameReader(), b"".join(packed(*frame) for frame in SENT), []
    for at in range(0, len(wire), size):
        reader.feed(wire[at : at + size])
        while (frame := reader.take()) is not None:
            taken.append(tuple(frame))
    assert taken == SENT


def test_every_bit_counts():
    wire, rng = packed(Kind.COMMAND, b"forty-two"), np.random.default_rng(2)
    for bit in range(8 * len(wire)):
        turned = bytearray(wire)
        turned[bit // 8] ^= 1 << bit % 8
        reader = FrameReader()
        reader.feed(bytes(turned))
        try:
            assert reader.take() is None  # it waits for more, which a longer length asks for
            assert 8 <= bit // 8 < 12
        except LinkError:
            pass
    for _ in range(50):
        reader = FrameReader()
        reader.feed(rng.bytes(64))
        with pytest.raises(LinkError, match="no message of surefoot"):
            reader.take()


@pytest.mark.parametrize(
    ("wire", "said"),
    [
        (b"GET / HTTP/1.1\r\n", "begins with b'GET / HT' and is no message of surefoot"),
        (MAGIC + b"\2\6" + bytes(10), "a message of protocol 2 where 1 is spoken"),
        (MAGIC + b"\1\6\0\0" + b"\xff\xff\xff\x7f" + bytes(4), "a message of 2147483647 bytes, of which 1048576"),
        (MAGIC + b"\1\x63" + bytes(10), "a message of unknown kind 99"),
        (packed(Kind.END, b"a")[:-1] + b"b", "whose checksum is wrong"),
    ],
)
def test_what_is_no_frame_is_said_in_a_sentence(wire, said):
    reader = FrameReader()
    reader.feed(wire)
    with pytest.raises(LinkError, match=said):
        reader.take()


def test_a_link_says_that_the_other_side_is_gone(pair):
    link, theirs = pair
    theirs.sendall(packed(*SENT[1])[:-1])
    assert link.receive(0.01) is None
    theirs.close()
    with pytest.raises(LinkError, match="has closed the connection"):
        link.receive(1.0)


def test_one_who_does_not_read_holds_nobody_up_for_ever(pair):
    link, _ = pair
    large, begin = bytes(1 << 20), time.monotonic()
    with pytest.raises(LinkError, match=r"has taken no message for 0\.2 s"):
        for _ in range(64):
            link.send(Kind.STATE, large, 0.2)
    assert time.monotonic() - begin < 5.0
    assert not all(link.offer(Kind.STATE, large) for _ in range(64))


def test_what_is_offered_arrives(pair):
    link, theirs = pair
    assert link.offer(Kind.STATE, b"abc")
    assert theirs.recv(100) == packed(Kind.STATE, b"abc")


def test_addresses():
    assert parsed("127.0.0.1:7", 9) == ("127.0.0.1", 7)
    assert parsed("robot", 9) == ("robot", 9)
    assert parsed(":7", 9) == ("127.0.0.1", 7)
    for wrong in ("robot:x", "robot:70000", "robot:0", "robot:"):
        with pytest.raises(LinkError, match="no address of a plant"):
            parsed(wrong, 9)


def test_nobody_there():
    with socket.create_server(("127.0.0.1", 0)) as listener:
        port = listener.getsockname()[1]
    with pytest.raises(LinkError, match=f"no plant at 127.0.0.1:{port}, .*; start one with: surefoot serve"):
        connected(f"127.0.0.1:{port}", 1.0)
