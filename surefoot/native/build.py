"""The C sources of this folder made into one shared library beside them.

The build of the package runs this file by its path, before anything is installed: it imports the standard library
alone. The same sources and compiler give the same bits: no fused multiplication, no reordering of sums, and of the
machine's instructions only those that every x86-64 processor since 2009 has.
"""

import hashlib
import json
import os
import platform
import re
import shlex
import shutil
import subprocess
import sys
import sysconfig
import tempfile
from pathlib import Path

FOLDER = Path(__file__).parent
LIBRARY = FOLDER / ("kernels.c" + {"win32": ".dll", "darwin": ".dylib"}.get(sys.platform, ".so"))
"""The library; the dot in its stem tells `pkgutil` that it is no module."""

FLAGS = ("-std=c11", "-O3", "-ffp-contract=off", "-fno-math-errno", "-fPIC", "-shared")
BASELINE = {"x86_64": ("-march=x86-64-v2",), "AMD64": ("-march=x86-64-v2",)}
"""Further flags by machine."""


def digest() -> str:
    """Digest of the sources and of how they are compiled."""
    found = hashlib.sha256(repr((FLAGS, BASELINE)).encode())
    for path in sorted((*FOLDER.glob("*.h"), *FOLDER.glob("*.c"))):
        found.update(path.name.encode() + b"\0" + path.read_bytes() + b"\0")
    return found.hexdigest()[:16]


def is_built() -> bool:
    """Whether there is a library of these very sources. It is not loaded: one that is stale would then stay."""
    return LIBRARY.exists() and digest().encode() in LIBRARY.read_bytes()


def platform_tag(library: bytes | None = None) -> str:
    """Which platforms a wheel with the library in it runs on, as the last part of its tag.

    On Linux those whose glibc has the symbols that the library asks for: ``manylinux_2_35_x86_64`` (PEP 600) where the
    newest of them came with glibc 2.35, and at least 2.17, which is the oldest that installers know by that name.

    Args:
        library: its content; that which is built by default.
    """
    platform_name = sysconfig.get_platform().replace("-", "_").replace(".", "_")
    content = LIBRARY.read_bytes() if library is None else library
    asked = [int(minor) for minor in re.findall(rb"GLIBC_2\.(\d+)", content)]
    if not asked or not platform_name.startswith("linux_"):
        return platform_name
    return f"manylinux_2_{max(17, *asked)}_{platform_name.removeprefix('linux_')}"


def build() -> str:
    """Compile the library anew and put it in its place at once, so that others may do the same meanwhile.

    The compiler is ``CC``, or ``cc``.

    Returns:
        Why there is none; empty if there is one.
    """
    command = shlex.split(os.environ.get("CC", "cc"))
    if not command or shutil.which(command[0]) is None:
        return f"no C compiler '{' '.join(command)}'"
    flags = (*command[1:], *FLAGS, *BASELINE.get(platform.machine(), ()))
    told = (f'-DSUREFOOT_DIGEST="{digest()}"', f"-DSUREFOOT_FLAGS={json.dumps(shlex.join(flags))}")
    sources = sorted(path.name for path in FOLDER.glob("*.c"))
    try:
        with tempfile.TemporaryDirectory(dir=FOLDER) as scratch:
            made = Path(scratch, LIBRARY.name)
            done = subprocess.run(
                [command[0], *flags, *told, "-o", str(made), *sources, "-lm"],
                cwd=FOLDER,
                capture_output=True,
                text=True,
            )
            if done.returncode or not made.exists():
                said = done.stderr.strip().splitlines()
                return f"no library: '{shlex.join(command)}' fails" + (f": {said[0]}" if said else "")
            made.replace(LIBRARY)
    except OSError as error:
        return f"no library: {error}"
    return ""
