"""Git LFS pointers: short texts that stand in a file's place until `git lfs pull` has brought its content.

The format is https://github.com/git-lfs/git-lfs/blob/main/docs/spec.md; Git LFS still reads its two older names.
"""

import re

IS_A_POINTER = "a Git LFS pointer, not the file itself; run 'git lfs pull'"
"""The fault and what would be right, to be said behind the name of the file."""

POINTER_BYTES = 1024
"""No pointer is longer, so that so many bytes of a file are enough to know [bytes]."""

_VERSION = re.compile(
    rb"(?:\xef\xbb\xbf)?\s*version https?://(?:git-lfs\.github\.com/spec|hawser\.github\.com/spec|git-media\.io)/v"
)


def is_pointer(head: bytes) -> bool:
    """Return true if a file that begins with these bytes is a Git LFS pointer: its first line is always its version."""
    return _VERSION.match(head) is not None
