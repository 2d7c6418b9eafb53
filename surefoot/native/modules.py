"""The modules that are compiled: each Python file with a ``.pxd`` beside it, which gives its types in C.

The same file runs interpreted where it is not compiled, many times slower. Cython and a C compiler make an extension
module beside each, which Python then imports in its place. The build of the package runs this file by its path, before
anything is installed: it imports the standard library alone.

The same sources, Cython and compiler give the same bits: no fused multiplication, no reordering of sums, and of the
machine's instructions only those that every x86-64 processor since 2009 has.
"""

import hashlib
import json
import os
import platform
import sys
from collections.abc import Iterable, Mapping
from importlib.machinery import EXTENSION_SUFFIXES
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from concurrent.futures import Future

# What only a build needs is imported there: each process of a checkout asks here whether modules are stale.

ROOT = Path(__file__).parents[2]
"""Folder that holds the package: of a checkout, its root."""

SUFFIX = EXTENSION_SUFFIXES[0]
"""End of the name of an extension module, which tells the version of Python and the platform."""

STAMP = Path(__file__).with_name(f"built{SUFFIX}.json")
"""Record of the build of the extension modules: of what, and how."""

SHARED = "surefoot.native.shared"
"""Module with what all compiled ones have in common, which Cython writes."""

DIRECTIVES = {
    "language_level": "3",
    "annotation_typing": "False",
    "infer_types": "True",
    "cdivision": "True",
    "initializedcheck": "False",
}
"""Directives for Cython: types by the `.pxd` and by inference, divisors unchecked."""

UNCHECKED = {"boundscheck": "False", "wraparound": "False"}
"""The same of modules that have arrays of C: no index is looked at, nor counted from the end, of lists either."""

ARRAYS, OTHERS = "-O3", "-O1"
"""Optimisation of modules that have arrays of C, and of those that call others: they compile in half the time."""

FLAGS = ("-ffp-contract=off", "-fno-math-errno", "-fPIC", "-w", "--param=vect-max-version-for-alias-checks=200")
"""The last one lets loops over many rows of an array become vector instructions; GCC tests first
that the rows are apart."""

BASELINE = {"x86_64": ("-march=x86-64-v2",), "AMD64": ("-march=x86-64-v2",)}
"""Further flags by machine."""

LINK = {"darwin": ("-bundle", "-undefined", "dynamic_lookup")}.get(sys.platform, ("-shared",))


SLOWER = 13
"""About how many times as long as a compiled walk an interpreted one takes."""

LOT = 8
"""Modules at most that one process of Cython reads; it takes as long to start as to read three."""

MOST_LINES = 30
"""Most lines that are shown of what Cython or the compiler says."""


class BuildError(Exception):
    """A module cannot be compiled; its text is what the compiler says."""


class NothingCompilesError(BuildError):
    """There is no compiling here; its text is the reason, with what would be right."""


def sources() -> Mapping[str, Path]:
    """Source of each compiled module by its name, relative to `ROOT`."""
    found = {}
    # The folders of the package are links in a checkout.
    for folder, _, names in os.walk(ROOT / "surefoot", followlinks=True):
        for name in names:
            if name.endswith(".pxd"):
                path = Path(folder, name).relative_to(ROOT)
                # A form of its own for the compiler goes before the one for the interpreter.
                own = path.with_suffix(".pyx")
                found[".".join(path.with_suffix("").parts)] = own if (ROOT / own).exists() else path.with_suffix(".py")
    return dict(sorted(found.items()))


def has_arrays(path: Path) -> bool:
    """Return true if a source, relative to `ROOT`, has arrays of C, so that its indices are not looked at."""
    return "[:" in (ROOT / path).with_suffix(".pxd").read_text(encoding="utf-8")


def target(path: Path) -> Path:
    """Path of the extension module of a source, relative to `ROOT`."""
    return path.with_name(path.stem + SUFFIX)


def shared_path() -> Path:
    """Path of the module with what all have in common, relative to `ROOT`."""
    return target(Path(*SHARED.split(".")).with_suffix(".py"))


def digests() -> Mapping[str, str]:
    """Digest of each module's source, of the types in C that it knows, and of how it is compiled."""
    found = sources()
    types = {name: (ROOT / path).with_suffix(".pxd").read_text(encoding="utf-8") for name, path in found.items()}
    needs = {name: types.keys() & _cimported(text) for name, text in types.items()}
    how = hashlib.sha256(repr((DIRECTIVES, UNCHECKED, FLAGS, BASELINE, LINK)).encode())
    made = {}
    for name, path in found.items():
        known, left = {name}, [name]
        while left:
            fresh = needs[left.pop()] - known
            known |= fresh
            left += fresh
        digest = how.copy()
        for text in ((ROOT / path).read_text(encoding="utf-8"), *(types[other] for other in sorted(known))):
            digest.update(text.encode() + b"\0")
        made[name] = digest.hexdigest()[:16]
    return made


def _cimported(text: str) -> set[str]:
    """Modules that a ``.pxd`` names, and names of them that may be modules."""
    found = set()
    for line in text.splitlines():
        words = line.replace(",", " ").split()
        if "cimport" in words:
            names = words[words.index("cimport") + 1 :]
            found |= {words[1], *(f"{words[1]}.{name}" for name in names)} if words[0] == "from" else set(names)
    return found


def stamp() -> Mapping[str, str]:
    """Record of the build: digest of each module, and under ``made`` how; empty where nothing was built."""
    try:
        kept: dict[str, str] = json.loads(STAMP.read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return {}
    return kept


def stale() -> list[str]:
    """Modules without an extension module of their present source, and built ones that have none any more."""
    built, found = stamp(), sources()
    late = [
        name
        for name, digest in digests().items()
        if built.get(name) != digest or not (ROOT / target(found[name])).exists()
    ]
    return [*late, *(name for name in built if name.startswith("surefoot.") and name not in found)]


def made() -> str:
    """Cython, compiler and flags that made the extension modules; empty where they are interpreted."""
    return stamp().get("made", "")


def built() -> list[Path]:
    """Files that a build leaves, relative to `ROOT`: the extension modules and what they were made of."""
    return [*(target(path) for path in sources().values()), shared_path(), STAMP.relative_to(ROOT)]


def tag() -> str:
    """Tag of a wheel with the extension modules in it: version of Python, and platform.

    On Linux that is one whose glibc has the symbols that they ask for: ``manylinux_2_35_x86_64`` (PEP 600) where the
    newest of them came with glibc 2.35, and at least 2.17, which is the oldest that installers know by that name.
    """
    python = f"cp{sys.version_info.major}{sys.version_info.minor}"
    return f"{python}-{python}-{platform_tag((ROOT / path).read_bytes() for path in built())}"


def platform_tag(contents: Iterable[bytes]) -> str:
    """Last part of the tag of a wheel that holds libraries with these contents."""
    import re
    import sysconfig

    name = sysconfig.get_platform().replace("-", "_").replace(".", "_")
    asked = {int(minor) for content in contents for minor in re.findall(rb"GLIBC_2\.(\d+)", content)}
    if not asked or not name.startswith("linux_"):
        return name
    return f"manylinux_2_{max(17, *asked)}_{name.removeprefix('linux_')}"


def missing() -> str:
    """Reason why the modules run interpreted; empty where they are compiled."""
    kept = stamp()
    return (
        ""
        if "made" in kept
        else kept.get("interpreted", "this installation was made without a C compiler; make it again with one")
    )


def refresh() -> None:
    """Compile anew what is stale in a checkout; where nothing can be compiled all of it runs interpreted from then on.

    Compiled modules call each other in C, so that either all of them are compiled or none.

    Raises:
        ImportError: a module cannot be compiled.
    """
    # The program that compiles them does so by itself, also where one of them cannot be.
    asked = "surefoot.native" in sys.orig_argv
    if asked or not (ROOT / "pyproject.toml").exists() or "interpreted" in stamp():
        return
    late = stale()
    if not late:
        return
    try:
        build(late)
    except NothingCompilesError as error:
        interpret(str(error))
    except BuildError as error:
        raise ImportError(f"{error}\nMend it, or run 'python -m surefoot.native --interpreted'") from None


def interpret(why: str) -> None:
    """Let all modules run interpreted until they are built again."""
    for path in (*map(target, sources().values()), shared_path()):
        (ROOT / path).unlink(missing_ok=True)
    _write_stamp({"interpreted": why})


def build(names: Iterable[str] | None = None) -> None:
    """Compile modules, each put in its place at once, so that others may do the same meanwhile.

    The compiler is ``CC``, or ``cc``, or that of the package ``ziglang``.

    Args:
        names: of the modules; all by default. Of none, where nothing can be compiled, all stay as they are.

    Raises:
        NothingCompilesError: there is no Cython, no compiler, or no header of Python's.
        BuildError: a module cannot be compiled.
    """
    import tempfile
    from concurrent.futures import ThreadPoolExecutor

    asked = None if names is None else list(names)
    try:
        compiler = _compiler()
        how = _how(compiler)
    except NothingCompilesError:
        if asked == []:
            return
        raise
    found = sources()
    fresh = digests()
    kept = stamp()
    wanted = list(found) if asked is None or kept.get("made") != how else [name for name in asked if name in found]
    for gone in kept.keys() - found.keys():
        (ROOT / target(Path(*gone.split(".")).with_suffix(".py"))).unlink(missing_ok=True)
    with tempfile.TemporaryDirectory(prefix="surefoot-") as folder:
        if kept.get("made") != how or not (ROOT / shared_path()).exists():
            _compile_shared(compiler, Path(folder))
        with ThreadPoolExecutor(os.cpu_count()) as pool:
            lots = list(_lots({name: found[name] for name in wanted}))
            written = [pool.submit(_translate, lot, Path(folder, str(number))) for number, lot in enumerate(lots)]
            running = [
                (name, pool.submit(_compile, compiler, path, Path(folder, str(number)), written[number]))
                for number, lot in enumerate(lots)
                for name, path in lot.items()
            ]
    failed = {name: task.exception() for name, task in running if task.exception() is not None}
    done = {name: digest for name, digest in kept.items() if name in found} | {name: fresh[name] for name in wanted}
    _write_stamp({"made": how, **{name: digest for name, digest in done.items() if name not in failed}})
    for error in failed.values():
        assert error is not None
        raise error


def has_compiler() -> bool:
    """Return true if this machine has the C compiler that is asked for."""
    import shlex
    import shutil

    command = shlex.split(os.environ.get("CC", "cc"))
    return bool(command) and shutil.which(command[0]) is not None


def _compiler() -> list[str]:
    """Command of the C compiler."""
    import shlex
    import sysconfig
    from importlib.util import find_spec

    header = Path(sysconfig.get_paths()["include"], "Python.h")
    version = f"{sys.version_info.major}.{sys.version_info.minor}"
    if find_spec("Cython") is None:
        raise NothingCompilesError("there is no Cython; run 'pip install cython'")
    if not header.exists():
        raise NothingCompilesError(f"there are no headers of Python; install them, such as python{version}-dev")
    if has_compiler():
        return shlex.split(os.environ.get("CC", "cc"))
    if find_spec("ziglang") is None:
        command = os.environ.get("CC", "cc")
        raise NothingCompilesError(f"there is no C compiler '{command}'; install one, or run 'pip install ziglang'")
    return [sys.executable, "-m", "ziglang", "cc"]


def _how(compiler: list[str]) -> str:
    """Versions of Cython and compiler, and the flags."""
    import shlex
    import subprocess
    from importlib.metadata import version

    asked = subprocess.run([*compiler, "--version"], capture_output=True, text=True)
    if asked.returncode or not asked.stdout:
        raise NothingCompilesError(f"'{shlex.join(compiler)}' is no C compiler that works; install one, or set CC")
    named = asked.stdout.splitlines()[0].strip()
    return f"Cython {version('cython')}, {named} {ARRAYS} or {OTHERS} {shlex.join(_flags(compiler))}"


def _flags(compiler: list[str]) -> list[str]:
    baseline: tuple[str, ...] = BASELINE.get(platform.machine(), ())
    if "ziglang" in compiler:
        baseline = tuple(flag.replace("86-64-", "86_64_") for flag in baseline)
    return [*compiler[1:], *FLAGS, *baseline]


def _compile_shared(compiler: list[str], folder: Path) -> None:
    c_file = folder / "shared.c"
    _run([sys.executable, "-m", "cython", f"--generate-shared={c_file}"])
    _link([*compiler, ARRAYS], c_file, shared_path())


def _lots(wanted: Mapping[str, Path]) -> Iterable[Mapping[str, Path]]:
    """Modules that Cython reads in one process, which take the same directives and whose files have unlike names."""
    lots: list[dict[str, Path]] = []
    for name, path in wanted.items():
        for lot in lots:
            others = list(lot.values())
            alike = has_arrays(others[0]) == has_arrays(path)
            if alike and len(lot) < LOT and path.stem not in [other.stem for other in others]:
                lot[name] = path
                break
        else:
            lots.append({name: path})
    return lots


def _translate(lot: Mapping[str, Path], folder: Path) -> None:
    """Write the C of each module of a lot into a folder of its own."""
    folder.mkdir()
    paths = list(lot.values())
    chosen = {**DIRECTIVES, **(UNCHECKED if has_arrays(paths[0]) else {})}
    directives = [part for key, value in chosen.items() for part in ("-X", f"{key}={value}")]
    command = [sys.executable, "-m", "cython", f"--shared={SHARED}", *directives]
    _run([*command, *map(str, paths), "-o", str(folder)])


def _compile(compiler: list[str], path: Path, folder: Path, written: "Future[None]") -> None:
    written.result()
    _link([*compiler, ARRAYS if has_arrays(path) else OTHERS], folder / f"{path.stem}.c", target(path))


def _link(compiler: list[str], c_file: Path, path: Path) -> None:
    import shutil
    import sysconfig

    scratch = c_file.with_suffix(SUFFIX)
    include = sysconfig.get_paths()["include"]
    same = f"-ffile-prefix-map={c_file.parent}=."  # the same bytes wherever it is compiled
    _run([compiler[0], *_flags(compiler), *LINK, same, "-I", include, "-o", str(scratch), str(c_file), "-lm"])
    beside = (ROOT / path).with_name(f".{path.name}.{os.getpid()}")
    shutil.copyfile(scratch, beside)
    beside.replace(ROOT / path)


def _run(command: list[str]) -> None:
    import shlex
    import subprocess

    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True)
    if done.returncode:
        said = (done.stderr or done.stdout).strip().splitlines()
        # Cython warns of all modules that it is given before it says what is wrong with one.
        begin = next((number for number, line in enumerate(said) if line.startswith("Error")), 0)
        raise BuildError("\n".join([f"'{shlex.join(command)}' fails:", *said[begin : begin + MOST_LINES]]))


def _write_stamp(content: Mapping[str, str]) -> None:
    scratch = STAMP.with_name(f".{STAMP.name}.{os.getpid()}")
    scratch.write_text(json.dumps(content, indent=1), encoding="utf-8")
    scratch.replace(STAMP)
