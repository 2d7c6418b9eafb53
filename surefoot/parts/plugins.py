"""Plug-ins of other packages: objects found by entry point, and registered in the running process.

A package says in its ``pyproject.toml`` what it has, and every command finds it:

    [project.entry-points."surefoot.profiles"]
    my-law = "my_package.laws:PROFILE"

Nothing is imported before the name is asked for. Whatever such an object does, a `Guard` stands around its calls.
"""

import os
import sys
from collections.abc import Collection, Iterator, Mapping
from contextlib import redirect_stdout
from dataclasses import dataclass
from functools import lru_cache
from importlib import import_module
from typing import TYPE_CHECKING, Any, Protocol, TypeVar, cast

from surefoot.errors import PluginError
from surefoot.parts.guard import OWN_GUARD, OWN_PACKAGE, Guard, said

if TYPE_CHECKING:
    from importlib.metadata import EntryPoint, EntryPoints

__all__ = ["OWN_PACKAGE", "At", "Declared", "Own", "PluginError", "Registry", "entry_points", "package_of"]

AFRESH = "install its package again where entry points have changed"
"""Command that makes known what entry points have been added or renamed in a package which is installed already."""

T = TypeVar("T")


class Registry(Mapping[str, T]):
    """Objects of one kind by name: those of this package, those registered by code, those found by entry point.

    A name of this package always means this package's object. The order of names is: own ones as given, then others
    sorted.

    Args:
        group: group of entry points, such as ``surefoot.profiles``.
        kind: class that every object must be an instance of; None for what is called, a function or a class.
        own: the objects of this package.
    """

    def __init__(self, group: str, kind: type[T] | None, own: Mapping[str, T]) -> None:
        self.group = group
        self._kind = kind
        self._own: dict[str, T] = dict(own)
        self._added: dict[str, T] = {}
        self._loaded: dict[str, T] = {}

    @property
    def _names(self) -> Collection[str]:
        """Own names."""
        return self._own

    def _find(self, name: str) -> T | None:
        """The object of an own name; None for others."""
        return self._own.get(name)

    def others(self) -> list[str]:
        """Names that are not this package's own, sorted."""
        found = {entry.name for entry in entry_points(group=self.group)} | set(self._added)
        return sorted(found - set(self._names)) if found else []

    @property
    def hint(self) -> str:
        """Hint for a name that there is not, to be said after the names; empty where no package is."""
        return f"; if a package brings it, {AFRESH}" if self.others() else ""

    def add(self, name: str, thing: T) -> T:
        """Register an object for the running process, over one of the same name that was added before.

        Raises:
            PluginError: the name is taken by this package, or the object is of another kind.
        """
        if name in self._names:
            raise PluginError(f"'{name}' of {self.group} is surefoot's own", "choose another name")
        self._added[name] = self._checked(thing, f"'{name}'")
        return thing

    def discard(self, name: str) -> None:
        """Take back what was added, if it was."""
        self._added.pop(name, None)

    def forget(self) -> None:
        """Forget what was loaded of other packages; each is loaded again when it is asked for."""
        self._loaded.clear()

    def __getitem__(self, name: str) -> T:
        """The object of that name.

        Raises:
            KeyError: there is none.
            PluginError: its package cannot be loaded, or gives something of another kind, or two packages have it.
        """
        if (own := self._find(name)) is not None:
            return own
        for known in (self._added, self._loaded):
            if name in known:
                return known[name]
        entries = self._entries(name)
        if not entries:
            raise KeyError(name)
        packages = [package_of(entry) for entry in entries]
        if len(entries) > 1:
            raise PluginError(f"'{name}' in {self.group} is of packages {' and '.join(packages)}", "remove one of them")
        self._loaded[name] = thing = self._checked(_load(entries[0]), f"'{name}' of package {packages[0]}")
        return thing

    def __iter__(self) -> Iterator[str]:
        return iter((*self._names, *self.others()))

    def __len__(self) -> int:
        return sum(1 for _ in self)

    def __contains__(self, name: object) -> bool:
        return any(name in known for known in (self._names, self._added, self._loaded)) or name in list(self)

    def package(self, name: str) -> str:
        """Package that brings a name; empty for what was registered by code, both where two bring it."""
        if name in self._names:
            return OWN_PACKAGE
        return "" if name in self._added else " and ".join(map(package_of, self._entries(name)))

    def guard(self, name: str) -> Guard:
        """A guard for the calls of the object of a name, which is one of those that there are."""
        if name in self._names:
            return OWN_GUARD
        package = self.package(name)
        if package == OWN_PACKAGE:
            return OWN_GUARD
        kind = self.group.removeprefix(f"{OWN_PACKAGE}.").removesuffix("s")
        return Guard(f"{kind} '{name}' of {f'package {package}' if package else 'this program'}")

    def owns(self, thing: object) -> bool:
        """Return true if an object is one of this package's own."""
        return any(thing is self._find(name) for name in self._names)

    def clashes(self) -> dict[str, PluginError]:
        """Messages for each name of surefoot's own under which another package has something too.

        The name goes on meaning surefoot's; the other thing is never looked at.
        """
        entries = entry_points(group=self.group)
        brought = {entry.name for entry in entries if package_of(entry) == OWN_PACKAGE}
        return {
            entry.name: PluginError(
                f"'{entry.name}' of package {package_of(entry)} in {self.group} has the name of one of surefoot's own",
                "give it another name there, or remove it",
            )
            for entry in entries
            if package_of(entry) != OWN_PACKAGE and (entry.name in brought or entry.name in self._names)
        }

    def refusal(self, name: str) -> PluginError | None:
        """Reason why a name cannot be used as it is; None where nothing is wrong with it, or there is none.

        Its package cannot be used, or has something else under a name of surefoot's own.
        """
        if name in self._names:
            return self.clashes().get(name)
        try:
            _ = self[name]
        except KeyError:
            return None
        except PluginError as refusal:
            return refusal
        return None

    def _entries(self, name: str) -> "list[EntryPoint]":
        """Entry points of a name; of several, the one of this package alone."""
        found = [entry for entry in entry_points(group=self.group) if entry.name == name]
        return [entry for entry in found if package_of(entry) == OWN_PACKAGE] or found

    def _checked(self, thing: object, who: str) -> T:
        wanted = "a function or a class" if self._kind is None else f"a {self._kind.__name__}"
        if callable(thing) if self._kind is None else isinstance(thing, self._kind):
            return cast("T", thing)
        if self._kind is not None and isinstance(thing, type) and issubclass(thing, self._kind):
            raise PluginError(f"{who} in {self.group} is the class {thing.__name__}", "register an instance of it")
        raise PluginError(f"{who} in {self.group} is of type {type(thing).__name__}", f"it must be {wanted}")


class Own(Protocol):
    """A part of this package, which need not be imported to be known."""

    @property
    def said(self) -> str:
        """Its text, in one line without a full stop."""
        ...

    def load(self) -> Any:
        """The part itself, imported now."""
        ...


@dataclass(frozen=True, slots=True)
class At:
    """A part at a place of the code, as an entry point has it.

    Attributes:
        said: what it is, in one line without a full stop.
        place: ``module:object``.
    """

    said: str
    place: str

    def load(self) -> Any:
        """The object there."""
        return _at(self.place)


class Declared(Registry[T]):
    """A registry whose own parts are a list of names, of a line each, and of places to import them from when asked for.

    Args:
        group: group of entry points.
        kind: place of the class of all objects, as ``module:class``; None for what is called, a function or a class.
        own: the parts of this package by name.
    """

    def __init__(self, group: str, kind: str | None, own: Mapping[str, Own]) -> None:
        super().__init__(group, None, {})
        self._kind_at, self._declared = kind, own

    @property
    def said(self) -> Mapping[str, str]:
        """Texts on each of its own, by name; read when they are asked for."""
        return {name: own.said for name, own in self._declared.items()}

    @property
    def _names(self) -> Collection[str]:
        return self._declared.keys()

    def _find(self, name: str) -> T | None:
        if name not in self._own and name in self._declared:
            self._own[name] = self._checked(self._declared[name].load(), f"'{name}'")
        return self._own.get(name)

    def _checked(self, thing: object, who: str) -> T:
        if self._kind is None and self._kind_at is not None:
            self._kind = _at(self._kind_at)
        return super()._checked(thing, who)


def _at(place: str) -> Any:
    """The object at ``module:object``."""
    module, _, name = place.partition(":")
    return getattr(import_module(module), name)


def entry_points(group: str) -> "EntryPoints":
    """Every entry point of a group, of the packages on ``sys.path``."""
    found: EntryPoints = _entry_points(tuple((place, _changed(place)) for place in sys.path)).select(group=group)
    return found


@lru_cache(maxsize=1)
def _entry_points(_places: tuple[tuple[str, int], ...]) -> Any:
    """Entry points of any group, found once, and again when a package was installed since, which alters a place."""
    from importlib import metadata  # which imports what reads letters, and a command may need no package

    return metadata.entry_points()


def _changed(place: str) -> int:
    try:
        return os.stat(place or ".").st_mtime_ns  # noqa: PTH116  twenty paths for each look, and several looks a run
    except OSError:
        return 0


def package_of(entry: "EntryPoint") -> str:
    """Name of the package that an entry point is of, for messages."""
    return entry.dist.name if entry.dist is not None else entry.value


def _load(entry: "EntryPoint") -> object:
    """Load what an entry point leads to; what its package prints meanwhile goes to where messages go.

    Raises:
        PluginError: it cannot be loaded, whatever the reason.
    """
    try:
        with redirect_stdout(sys.stderr):
            return entry.load()
    except KeyboardInterrupt:
        raise
    except BaseException as error:
        what = f"'{entry.name}' of package {package_of(entry)} cannot be loaded, {said(error)}"
        # Of an editable package the entry points are those of its installation, whatever has been written since.
        gone = isinstance(error, ImportError | AttributeError)
        raise PluginError(what, f"mend or remove it, and {AFRESH}" if gone else "mend or remove it") from error
