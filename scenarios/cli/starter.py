"""The text to start a scenario of one's own from."""

import re
from collections.abc import Iterator, Sequence
from typing import Any

import yaml

from surefoot.scenarios import catalogue
from surefoot.scenarios.cli import texts
from surefoot.scenarios.cli.files import brought, content

_EDITOR = """\
# Every key has a default; `surefoot schema > surefoot.schema.json` lets an editor complete and check them:
# yaml-language-server: $schema=surefoot.schema.json
"""
_KEY = re.compile(r"( *)(\w+):(?: +[^#|>\s][^#]*)?")
_COLUMN = 40


def starter(name: str) -> str:
    """YAML text of a scenario to start one's own from: each key with its meaning, and what lets an editor check them.

    That of a campaign, or of another kind of file that a package brings, is given as it is.

    Raises:
        ScenarioError: its file is too large or no UTF-8, or there is none.
    """
    if name not in catalogue.OURS and name not in catalogue.names():
        for files, _ in brought()[0].values():
            if name in files:
                return content(files[name])
    return commented(catalogue.text(name)[0])


def commented(text: str) -> str:
    """The text of a scenario with the meaning of each key; one that cannot be explained as it is."""
    lines = text.splitlines(keepends=True)
    head = next((number for number, line in enumerate(lines) if not line.startswith("#")), len(lines))
    made = "".join((*lines[:head], _EDITOR, *_explained(lines[head:])))
    said = _content(text)
    return made if said is not None and _content(made) == said else text


def _explained(lines: Sequence[str]) -> Iterator[str]:
    """Lines of a scenario, with a comment after each key of whose meaning something is known."""
    said = texts.entries("meanings")
    path: list[tuple[int, str]] = []
    for line in lines:
        key = _KEY.fullmatch(line.rstrip())
        if key is None:
            yield line
            continue
        path = [*((indent, name) for indent, name in path if indent < len(key[1])), (len(key[1]), key[2])]
        meaning = said.get(".".join(name for _, name in path), "")
        yield f"{key[0]:<{_COLUMN}}  # {meaning}\n" if meaning not in ("", key[2]) else line


def meanings() -> dict[str, str]:
    """Meaning of each key of a scenario, by its dotted name, as it follows from the sources."""
    from surefoot.scenarios.file.schema import Scenario
    from surefoot.scenarios.judge.metrics import OWN
    from surefoot.scenarios.show.options import keys

    return {**dict(keys(Scenario)), **{f"criteria.{name}": metric.meaning for name, metric in OWN.items()}}


def _content(text: str) -> Any:
    """Read a YAML text; None where it cannot be read."""
    try:
        return yaml.safe_load(text)
    except yaml.YAMLError:
        return None
