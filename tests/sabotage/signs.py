"""One sign of a law flipped, in each of some compiled modules drawn at random, and the unit test that finds it.

    python tests/sabotage/signs.py [--seed N] [--count N] [MODULE ...]

A module is drawn among those that are compiled and have a sign, and a sign among those of its functions. Signs of
places in arrays, of counts and of texts are none of a law. Each is tried in a copy of the folders of the code, compiled
there; the tests are the unit tests of the folder that mirrors the module's, and where these pass those that run the
function, of which the map of `tests/touched` tells. The tests that find them are at last run on the code as it is,
where they have to pass. Exits 1 where a sign survives.
"""

import argparse
import io
import random
import sys
import tempfile
import tokenize
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from keyword import iskeyword
from pathlib import Path

from mutants import ROOT, builds, copied, found_by

from surefoot.native.modules import STAMP, sources, target

sys.path.append(str(ROOT / "tests" / "touched"))
import edited
import touches

FLIPPED = {"+": "-", "-": "+", "+=": "-=", "-=": "+="}
"""Sign that another one becomes."""

COUNTS = {"range", "len", "slice", "zeros", "empty", "ones"}
"""Functions whose arguments are places, counts and shapes."""


@dataclass(frozen=True, slots=True)
class Sign:
    """A sign of a module.

    Attributes:
        line: where it is, from 1.
        column: where it is in its line, from 0.
        sign: as it is.
    """

    line: int
    column: int
    sign: str

    def flipped(self, text: str) -> str:
        """The module's text with the other sign."""
        lines = text.splitlines(keepends=True)
        line, end = lines[self.line - 1], self.column + len(self.sign)
        lines[self.line - 1] = line[: self.column] + FLIPPED[self.sign] + line[end:]
        return "".join(lines)


def signs(text: str) -> Iterator[Sign]:
    """Every sign of the laws in a module's functions, but of those that make objects."""
    tokens = [
        token
        for token in tokenize.generate_tokens(io.StringIO(text).readline)
        if token.type not in (tokenize.COMMENT, tokenize.NL)
    ]
    inside: list[str] = []
    depth, function, makes, header = 0, -1, False, False
    for before, token, after in zip(tokens, tokens[1:], tokens[2:], strict=False):
        depth += (token.type == tokenize.INDENT) - (token.type == tokenize.DEDENT)
        if function >= 0 and depth <= function and token.type == tokenize.DEDENT:
            function = -1
        if before.string in ("def", "cdef", "cpdef") and function < 0 and token.string != "class":
            function, header = depth, True
        if before.string == "def":
            makes = token.string == "__init__"
        if header:
            header = token.type != tokenize.NEWLINE
            continue
        if token.string in ("(", "["):
            inside.append(_kind(before, token))
        elif token.string in (")", "]"):
            inside.pop()
        elif token.string in FLIPPED and function >= 0 and not makes and "place" not in inside:
            if _counts(before) or _counts(after) or after.string == "[":
                continue
            yield Sign(token.start[0], token.start[1], token.string)


def _kind(before: tokenize.TokenInfo, token: tokenize.TokenInfo) -> str:
    """True if a bracket holds places and counts, and not values."""
    name = (before.type == tokenize.NAME and not iskeyword(before.string)) or before.string in (")", "]")
    of_an_array = token.string == "[" and name
    return "place" if of_an_array or before.string in COUNTS else "values"


def _counts(token: tokenize.TokenInfo) -> bool:
    """True if a neighbour of a sign is a whole number or a text."""
    return token.string.endswith(('"', "'")) or (token.type == tokenize.NUMBER and token.string.isdecimal())


def modules() -> list[Path]:
    """Sources of compiled modules that have a sign, relative to the root."""
    found = sorted((ROOT / path).resolve().relative_to(ROOT) for path in sources().values())
    return [path for path in found if any(signs((ROOT / path).read_text(encoding="utf-8")))]


def tests_of(module: Path) -> list[str]:
    """Tests of a module's own name first, then those of the folder that mirrors its folder."""
    parts = module.parent.parts
    folder = Path("tests", *parts[parts[0] == "surefoot" :])  # rooms of the package mirror at the root of the tests
    while not any((ROOT / folder).glob("test_*.py")):
        folder = folder.parent
    if folder == Path("tests"):
        return sorted(str(path.relative_to(ROOT)) for path in (ROOT / folder).glob("test_*.py"))
    own = folder / f"test_{module.stem}.py"
    return [str(own), str(folder)] if (ROOT / own).exists() else [str(folder)]


def runners(module: Path, sign: Sign) -> list[str]:
    """Tests of other folders that run the function of a sign, the quickest first."""
    known = touches.read()
    text = (ROOT / module).read_text(encoding="utf-8")
    names = edited.lines(text) if module.suffix == ".py" else []
    within = frozenset(name for lines, name in names if sign.line in lines)
    found = known.of(edited.Edit(module.as_posix(), module.as_posix(), within or None), ROOT, frozenset())
    near = tests_of(module)
    others = (test for test in found if not test.startswith(tuple(near)))
    return sorted(others, key=lambda test: (known.time(test) or 0.0, test))


def tried(place: Path, module: Path, sign: Sign) -> str:
    """The test that finds a sign flipped; empty where none does. The folder is left as it was, compiled modules too."""
    files = (place / module, place / target(module), place / STAMP.relative_to(ROOT))
    before = {file: file.read_bytes() for file in files if file.exists()}
    files[0].write_text(sign.flipped(before[files[0]].decode()), encoding="utf-8")
    if said := builds(place):
        raise SystemExit(f"{module}:{sign.line}: with the sign flipped it does not compile:\n{said}")
    found = found_by(place, tests_of(module))
    if not found and (others := runners(module, sign)):
        found = found_by(place, others)
    for file, content in before.items():
        file.write_bytes(content)
    return found


def drawn(seed: int, count: int, among: Sequence[Path]) -> list[tuple[Path, Sign]]:
    """So many modules, drawn at random, and a sign of each."""
    rng = random.Random(seed)
    chosen = rng.sample(among, min(count, len(among)))
    return [(path, rng.choice(list(signs((ROOT / path).read_text(encoding="utf-8"))))) for path in chosen]


def main() -> None:
    """Flip the signs one after the other, print which test finds each, and how many are found."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("modules", nargs="*", type=Path, help="draw among these, such as planner/recovery/reach.py")
    parser.add_argument("--seed", type=int, default=0, help="of the draw")
    parser.add_argument("--count", type=int, default=20, help="of modules")
    parser.add_argument("--line", type=int, help="flip all signs of this line of the one module, in place of a draw")
    options = parser.parse_args()
    known = modules()
    for module in options.modules:
        if module not in known:
            parser.error(f"{module} is no compiled module with a sign; give its path from {ROOT}, such as {known[0]}")
    chosen = drawn(options.seed, options.count, options.modules or known)
    if options.line is not None:
        every = signs((ROOT / options.modules[0]).read_text(encoding="utf-8"))
        chosen = [(options.modules[0], sign) for sign in every if sign.line == options.line]
    found: list[str] = []
    with tempfile.TemporaryDirectory() as folder:
        place = Path(folder)
        copied(place)
        for module, sign in chosen:
            line = (ROOT / module).read_text(encoding="utf-8").splitlines()[sign.line - 1]
            marked = f"{line[: sign.column]}[{sign.sign} -> {FLIPPED[sign.sign]}]{line[sign.column + len(sign.sign) :]}"
            found.append(tried(place, module, sign))
            print(f"{module}:{sign.line}: {marked.strip()}: {found[-1] or 'SURVIVED'}", flush=True)
        finders = sorted({test for test in found if "::" in test})
        failing = found_by(place, finders) if finders else ""
    if failing:
        raise SystemExit(f"{failing} fails without a sign flipped, too")
    count = sum(map(bool, found))
    print(f"{count} of {len(chosen)} flipped signs found, seed {options.seed}")
    sys.exit(count < len(chosen))


if __name__ == "__main__":
    main()
