"""The JSON Schema of scenario files as text."""

import json

from surefoot.kept import from_sources
from surefoot.scenarios.file.registries import REGISTRIES
from surefoot.scenarios.judge.names import METRICS


def schema_text() -> str:
    """The schema; made anew where another package brings names or keys into it, whose code nobody can see through."""
    if any(registry.others() for registry in (*REGISTRIES.values(), METRICS)):
        return _made()
    return from_sources("schema", _made)


def _made() -> str:
    from surefoot.scenarios.setup.criteria import published

    return json.dumps(published(), indent=2)
