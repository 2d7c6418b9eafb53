"""What stands beside a viewer's picture: templates that are filled, and the viewer's own page that takes them in."""

import json
from string import Template
from typing import Any


class _Template(Template):
    delimiter = "@"  # JavaScript has other uses for the usual one


def filled(template: str, data: Any = None, **names: str) -> str:
    """A template of a page with its names filled in.

    Args:
        template: text, in which ``@name`` stands for a name, and ``@data`` for the data.
        data: for a script, as JSON; what is no finite number cannot be in it.
        names: HTML by name.
    """
    # An end of the script inside a text would end it.
    told = json.dumps(data, allow_nan=False, separators=(",", ":")).replace("</", "<\\/")
    return _Template(template).substitute(names, data=told)


def taken_in(page: str, head: str, column: str) -> str:
    """A viewer's own page with elements before all in its head, and others behind all in its body."""
    before, inside = page.split("<head>", 1)
    top, after = inside.rsplit("</body>", 1)
    return f"{before}<head>{head}{top}{column}</body>{after}"
