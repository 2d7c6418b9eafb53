"""Write the texts of commands on the package's own parts into the package: the schema, meanings of keys, metrics.

python docs/texts.py
"""

import json
from collections.abc import Callable, Mapping

from surefoot.scenarios.cli import published, starter, texts
from surefoot.scenarios.file.registries import REGISTRIES
from surefoot.scenarios.judge.metrics import METRICS


def _metrics() -> str:
    return json.dumps(dict(METRICS.said), indent=1, ensure_ascii=False)


TEXTS: Mapping[str, Callable[[], str]] = {
    "schema": published.made,
    "meanings": lambda: json.dumps(starter.meanings(), indent=1, ensure_ascii=False),
    "metrics": _metrics,
}
"""Functions that make each text, by its name."""


def made(name: str) -> str:
    """A text as it follows from the sources."""
    return f"{TEXTS[name]()}\n"


def main() -> None:
    """Write all of them.

    Raises:
        SystemExit: another package is installed, whose parts would be among them.
    """
    if any(registry.others() for registry in (*REGISTRIES.values(), METRICS)):
        raise SystemExit("another package brings parts of its own; write the texts in an environment without")
    for name in TEXTS:
        (texts.FOLDER / f"{name}.json").write_text(made(name), encoding="utf-8")


if __name__ == "__main__":
    main()
