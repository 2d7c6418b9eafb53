"""What other packages bring: objects found by entry point, and registered in the running process.

A package says in its ``pyproject.toml`` what it has, and every command finds it:

    [project.entry-points."surefoot.profiles"]
    my-law = "my_package.laws:PROFILE"

Nothing is imported before the name is asked for.
"""

from collections.abc import Iterator, Mapping
from importlib.metadata import entry_points
from typing import Any


class PluginError(ValueError):
    """What a package has registered cannot be used; the message names the package, the entry and the reason."""


class Registry(Mapping[str, Any]):
    """Objects of one kind by name: those of this package, those registered by code, those found by entry point.

    A name of this package always means this package's object. The order of names is: own ones as given, then others
    sorted.

    Args:
        group: group of entry points, such as ``surefoot.profiles``.
        kind: class, or abstract one, that every object must be an instance of.
        own: the objects of this package.
    """

    def __init__(self, group: str, kind: Any, own: Mapping[str, Any]) -> None:
        self.group = group
        self._kind = kind
        self._own = dict(own)
        self._added: dict[str, Any] = {}
        self._loaded: dict[str, Any] = {}

    def add(self, name: str, thing: Any) -> Any:
        """Register an object for the running process, over one of the same name that was added before.

        Raises:
            PluginError: the name is taken by this package, or the object is of another kind.
        """
        if name in self._own:
            raise PluginError(f"'{name}' of {self.group} is surefoot's own; choose another name")
        self._added[name] = self._checked(thing, f"'{name}'")
        return thing

    def discard(self, name: str) -> None:
        """Take back what was added, if it was."""
        self._added.pop(name, None)

    def __getitem__(self, name: str) -> Any:
        """The object of that name.

        Raises:
            KeyError: there is none.
            PluginError: its package cannot be loaded, or gives something of another kind.
        """
        for known in (self._own, self._added, self._loaded):
            if name in known:
                return known[name]
        entry = next((entry for entry in entry_points(group=self.group) if entry.name == name), None)
        if entry is None:
            raise KeyError(name)
        package = entry.dist.name if entry.dist is not None else entry.value
        try:
            thing = entry.load()
        except Exception as error:
            reason = f"{type(error).__name__}: {error}"
            raise PluginError(f"'{name}' of package {package} cannot be loaded, {reason}; mend or remove it") from error
        self._loaded[name] = self._checked(thing, f"'{name}' of package {package}")
        return thing

    def __iter__(self) -> Iterator[str]:
        found = {entry.name for entry in entry_points(group=self.group)} | set(self._added)
        return iter((*self._own, *sorted(found - set(self._own))))

    def __len__(self) -> int:
        return sum(1 for _ in self)

    def __contains__(self, name: object) -> bool:
        return any(name == known for known in self)

    def _checked(self, thing: Any, who: str) -> Any:
        if not isinstance(thing, self._kind):
            raise PluginError(f"{who} in {self.group} is a {type(thing).__name__}; it must be a {self._kind.__name__}")
        return thing
