"""Build the documentation site, strictly: a broken link or reference is an error.

    python docs/site/build.py [FOLDER]        by default build/site; open its index.html

The site is the pages of docs/ as they stand, files of the root, and what `generated.py` makes of the code. They are
laid out in a folder of their own, where links that lead out of docs/ lead to a page again, and Sphinx makes HTML of it.
"""

import argparse
import posixpath
import re
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path

from generated import DOCS, ROOT, pages

FROM_ROOT = {
    "CHANGELOG.md": "project/changelog.md",
    "CONTRIBUTING.md": "project/contributing.md",
    "changes/README.md": "project/changes.md",
    "SECURITY.md": "project/security.md",
    "LICENSE": "project/licence.md",
}
"""Files of the root that are pages of the site."""

GENERATED = "<!-- site: generated -->"
"""Line of docs/index.md in whose place stand the pages that are no files of the repository."""

_LINK = re.compile(r"(\[(?:[^\[\]]|!\[[^\]]*\]\([^)]*\))*\]\()([^)#:\s]+)((?:#[^)]*)?\))")
_ROW = re.compile(r"(?m)^\| \[[^\]]+\]\(([\w./-]+\.md)\) \|")


def lay_out(folder: Path) -> None:
    """Write the sources of the site into an empty folder."""
    shutil.copytree(DOCS / "images", folder / "images", ignore=shutil.ignore_patterns("*.py", "__pycache__"))
    for path in sorted(DOCS.rglob("*")):
        if path.suffix in (".json", ".ipynb"):
            _write(folder / path.relative_to(DOCS), path.read_text(encoding="utf-8"))
    for path, text in texts().items():
        _write(folder / path, text)


def texts() -> dict[str, str]:
    """Markdown of every page by its path in the site."""
    found = {path.relative_to(DOCS).as_posix(): path.read_text(encoding="utf-8") for path in sorted(DOCS.rglob("*.md"))}
    made = pages()
    for name, page in FROM_ROOT.items():
        text = (ROOT / name).read_text(encoding="utf-8")
        made[page] = text if name.endswith(".md") else f"# Licence\n\n```text\n{text}```\n"
    found["index.md"] = found["index.md"].replace(GENERATED, "\n".join(map(_row, made.items())))
    found |= made
    return {path: with_contents(path, with_links(path, text)) for path, text in found.items()}


def _row(page: tuple[str, str]) -> str:
    """Row of the index for a page: its title, and the first sentence below it."""
    path, text = page
    title, _, rest = text.removeprefix("# ").partition("\n")
    said = re.match(r"\s*([A-Z][^:`#|]*?[.;])\s", rest)
    return f"| [{title}]({path}) | {' '.join(said[1].split()).rstrip('.;') if said else title} |"


def with_links(page: str, text: str) -> str:
    """A page whose links lead to places of the site."""
    return _LINK.sub(lambda found: found[1] + led(page, found[2]) + found[3], text)


def led(page: str, target: str) -> str:
    """Target of a link in the site.

    Args:
        page: path of its page in the site.
        target: the link as its file has it, which stands in docs/ or in the root.
    """
    of_root = page in FROM_ROOT.values()
    folder = "" if of_root else posixpath.join("docs", posixpath.dirname(page))
    path = posixpath.normpath(posixpath.join(folder, target))
    if path in FROM_ROOT:
        path = FROM_ROOT[path]
    elif path == "README.md":
        path = "index.md"
    elif path.startswith("examples"):
        path = "examples.md" + (f"#{posixpath.basename(path).replace('.', '')}" if path.endswith(".py") else "")
    elif of_root:
        path = path.removeprefix("docs/")
    else:
        return target
    return posixpath.relpath(path, posixpath.dirname(page) or ".")


def with_contents(page: str, text: str) -> str:
    """An index with the contents that the side of the site shows: the pages of its tables, by heading."""
    if posixpath.basename(page) != "index.md":
        return text
    return "\n".join([text, *_contents(text)])


def _contents(text: str) -> Iterator[str]:
    parts = re.split(r"(?m)^## (.*)$", text)
    for caption, part in zip(["", *parts[1::2]], parts[::2], strict=True):
        if listed := list(dict.fromkeys(_ROW.findall(part))):
            head = [f":caption: {caption}"] if caption else []
            yield "\n".join(["```{toctree}", ":hidden:", *head, "", *listed, "```", ""])


def _write(path: Path, text: str) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text, encoding="utf-8")


def main() -> None:
    """Build it."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", nargs="?", type=Path, default=ROOT / "build" / "site")
    folder = parser.parse_args().folder
    shutil.rmtree(folder, ignore_errors=True)
    with tempfile.TemporaryDirectory() as place:
        source = Path(place) / "source"
        source.mkdir()
        lay_out(source)
        strict = ("-W", "--keep-going", "-q", "-E", "-d", str(Path(place) / "doctrees"))
        command = [sys.executable, "-m", "sphinx", *strict, "-b", "html", "-c", str(Path(__file__).parent)]
        code = subprocess.run([*command, str(source), str(folder)], check=False).returncode
    if code == 0:
        print(folder / "index.html")
    sys.exit(code)


if __name__ == "__main__":
    main()
