"""A Git LFS pointer is known by its first line, and by nothing else."""

import pytest

from surefoot.pointers import POINTER_BYTES, is_pointer

pytestmark = pytest.mark.unit

OID = b"\noid sha256:4d7a214614ab2935c943f9e0ff69d22eadbb8f32b1258daaa5e2ca24d17e2393\nsize 12345\n"


@pytest.mark.parametrize(
    "version",
    [
        b"version https://git-lfs.github.com/spec/v1",
        b"version https://hawser.github.com/spec/v1",
        b"version http://git-media.io/v/2",
        b"\xef\xbb\xbfversion https://git-lfs.github.com/spec/v1\r",
    ],
)
def test_a_pointer_is_known(version):
    assert is_pointer(version + OID)
    assert len(version + OID) < POINTER_BYTES


@pytest.mark.parametrize(
    "head",
    [
        b"", b"\x89MCAP0\r\n", b"solid version", b"<mujoco/>", b"version https://example.org/spec/v1" + OID,
        b"# see version https://git-lfs.github.com/spec/v1" + OID, OID,
    ],
)  # fmt: skip
def test_anything_else_is_none(head):
    assert not is_pointer(head)
