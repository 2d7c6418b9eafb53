"""The JSON Schema of scenario files as text."""

import json

from surefoot.scenarios.cli import texts
from surefoot.scenarios.file.registries import REGISTRIES
from surefoot.scenarios.judge.names import METRICS


def schema_text() -> str:
    """The schema; made anew where another package brings names or keys into it."""
    if any(registry.others() for registry in (*REGISTRIES.values(), METRICS)):
        return made()
    return texts.text("schema").removesuffix("\n")


def made() -> str:
    """The schema as it follows from the sources and from all packages."""
    from surefoot.scenarios.setup.checks.criteria import published

    return json.dumps(published(), indent=2)
