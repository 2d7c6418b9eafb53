"""The scenarios that come with the package, found by name."""

from importlib.resources import files


def names() -> tuple[str, ...]:
    """Names of the catalogue's scenarios, sorted."""
    entries = (entry.name for entry in files(__name__).iterdir())
    return tuple(sorted(name.removesuffix(".yaml") for name in entries if name.endswith(".yaml")))


def text(name: str) -> str:
    """YAML text of a catalogue scenario."""
    return (files(__name__) / f"{name}.yaml").read_text(encoding="utf-8")


def summary(name: str) -> str:
    """First comment line of a catalogue scenario: what it is."""
    return text(name).split("\n", 1)[0].lstrip("# ")
