"""Put the files of changes/ into CHANGELOG.md, under their sections of `[Unreleased]`, and remove them.

python docs/changelog.py
"""

import re
from pathlib import Path

ROOT = Path(__file__).parents[1]
SECTIONS = ("added", "changed", "fixed", "removed")
_NAME = re.compile(rf"({'|'.join(SECTIONS)})-[a-z0-9-]+\.md")


def fragments(folder: Path) -> dict[str, str]:
    """Lines by section, in the order of the files' names.

    Raises:
        ValueError: a file has another name, or a line that is no item of a list.
    """
    found: dict[str, str] = {}
    for path in sorted(folder.glob("*")):
        if path.name == "README.md":
            continue
        name = _NAME.fullmatch(path.name)
        if name is None:
            raise ValueError(f"{path.name}: name it {'-, '.join(SECTIONS)}- and a word, with .md")
        text = path.read_text(encoding="utf-8").strip()
        if not all(line.startswith(("- ", "  ")) for line in text.splitlines()) or not text:
            raise ValueError(f"{path.name}: write lines that begin with '- '")
        found[name[1]] = found.get(name[1], "") + text + "\n"
    return found


def with_fragments(text: str, found: dict[str, str]) -> str:
    """The changelog with lines at the beginning of their sections; a section that lacks is made."""
    head, unreleased, rest = re.split(r"(?ms)(^## \[Unreleased\]\n.*?)(?=^## |\Z)", text, maxsplit=1)
    for section, lines in found.items():
        title = f"### {section.capitalize()}\n\n"
        if title in unreleased:
            unreleased = unreleased.replace(title, f"{title}{lines}\n", 1)
        else:
            unreleased = f"{unreleased.rstrip()}\n\n{title}{lines}\n"
    return head + unreleased + rest


def main() -> None:
    """Put them in."""
    folder, changelog = ROOT / "changes", ROOT / "CHANGELOG.md"
    changelog.write_text(with_fragments(changelog.read_text(encoding="utf-8"), fragments(folder)), encoding="utf-8")
    for path in folder.glob("*-*.md"):
        path.unlink()


if __name__ == "__main__":
    main()
