"""Frozen dataclasses whose methods are compiled when one is first made, not when their module is imported.

The standard library writes six methods of each frozen dataclass as text and compiles them, at every import: half a
millisecond a class, of which there are hundreds. Here five are functions that all of them share, and the constructor
is written when the first value is made. Values behave as those of `dataclasses` do, to which all else is left.
"""

import dataclasses
import inspect
from collections.abc import Callable, Iterator
from functools import partial
from operator import attrgetter
from reprlib import recursive_repr
from typing import TYPE_CHECKING, Any, TypeVar

if TYPE_CHECKING:
    from dataclasses import dataclass
else:

    def dataclass(cls=None, /, *, frozen=False, **options):
        """`dataclasses.dataclass`; what is frozen is compiled later."""
        if cls is None:
            return partial(dataclass, frozen=frozen, **options)
        if not frozen or not options.keys() <= {"slots", "eq", "repr"}:
            return dataclasses.dataclass(cls, frozen=frozen, **options)
        return _frozen(cls, **options)


__all__ = ["dataclass", "maker", "opened"]

_set = object.__setattr__

Made = TypeVar("Made")


def opened(cls: type) -> Any:
    """A class with the slots of a frozen dataclass and without its guard.

    Its fields are set by plain assignment, in a fifth of the time. What is made of it becomes a value by
    ``made.__class__ = cls`` before anybody else sees it.
    """
    return type(cls.__name__, (), {"__slots__": vars(cls)["__slots__"]})


class _Made:
    """Stands in a signature for a default that is made anew for each value."""

    def __repr__(self) -> str:
        return "<factory>"


_UNSET = _Made()


def _frozen(cls: type, slots: bool = False, eq: bool = True, repr: bool = True) -> type:
    """A class made a frozen dataclass."""
    told = set(vars(cls))
    hashed = told if vars(cls).get("__hash__") is not None else told - {"__hash__"}
    inherits = any(hasattr(base, "__dataclass_params__") for base in cls.__mro__[1:])  # which must say so too
    made: Any = dataclasses.dataclass(cls, init=False, repr=False, eq=False, frozen=inherits, slots=slots)
    params = made.__dataclass_params__
    params.init, params.repr, params.eq, params.frozen = True, repr, eq, True
    for name, method in _methods(made, eq, repr, slots):
        if name not in (hashed if name == "__hash__" else told):
            method.__name__, method.__qualname__ = name, f"{made.__qualname__}.{name}"
            setattr(made, name, method)
    if "__init__" not in told:
        made.__signature__ = _Signature(made)
    return made  # type: ignore[no-any-return]


def _methods(cls: Any, eq: bool, repr: bool, slots: bool) -> Iterator[tuple[str, Callable[..., Any]]]:
    """Methods of a class by name, nothing of which is compiled."""
    fields = dataclasses.fields(cls)
    names = tuple(field.name for field in fields)

    def construct(self: Any, *given: Any, **named: Any) -> None:
        _constructor(cls)(self, *given, **named)

    yield "__init__", construct
    if repr:
        yield "__repr__", _shown(tuple(field.name for field in fields if field.repr))
    if eq:
        yield "__eq__", _equal(_reader(tuple(field.name for field in fields if field.compare)))
        counted = [field.name for field in fields if (field.compare if field.hash is None else field.hash)]
        yield "__hash__", _hashed(_reader(tuple(counted)))
    yield from _guards(cls, names)
    if slots:
        yield "__getstate__", lambda self: [getattr(self, name) for name in names]
        yield "__setstate__", _restoring(names)


def _reader(names: tuple[str, ...]) -> Callable[[Any], tuple[Any, ...]]:
    """What reads fields of a value."""
    if len(names) > 1:
        return attrgetter(*names)
    return lambda value: tuple(getattr(value, name) for name in names)


def _equal(read: Callable[[Any], tuple[Any, ...]]) -> Callable[[Any, Any], Any]:
    def equal(self: Any, other: Any) -> Any:
        return read(self) == read(other) if other.__class__ is self.__class__ else NotImplemented

    return equal


def _hashed(read: Callable[[Any], tuple[Any, ...]]) -> Callable[[Any], int]:
    def hashed(self: Any) -> int:
        return hash(read(self))

    return hashed


def _shown(names: tuple[str, ...]) -> Callable[[Any], str]:
    @recursive_repr()
    def show(self: Any) -> str:
        return f"{type(self).__qualname__}({', '.join(f'{name}={getattr(self, name)!r}' for name in names)})"

    return show


def _guards(cls: Any, names: tuple[str, ...]) -> Iterator[tuple[str, Callable[..., None]]]:
    """What refuses to change a value; a class below that is no dataclass may have attributes of its own."""

    def assign(self: Any, name: str, value: Any) -> None:
        if type(self) is cls or name in names:
            raise dataclasses.FrozenInstanceError(f"cannot assign to field {name!r}")
        super(cls, self).__setattr__(name, value)

    def delete(self: Any, name: str) -> None:
        if type(self) is cls or name in names:
            raise dataclasses.FrozenInstanceError(f"cannot delete field {name!r}")
        super(cls, self).__delattr__(name)

    yield "__setattr__", assign
    yield "__delattr__", delete


def _restoring(names: tuple[str, ...]) -> Callable[[Any, list[Any]], None]:
    def restore(self: Any, state: list[Any]) -> None:
        for name, part in zip(names, state, strict=True):
            _set(self, name, part)

    return restore


_FEW = 3
"""Fields up to which each is set past the guard; more are set faster while the value is of an opened class."""


def _indented(lines: list[str]) -> list[str]:
    return [f" {line}" for line in lines]


def maker(cls: type[Made]) -> type[Made]:
    """A function that makes values of a frozen dataclass with slots as the class does, in half its time.

    The call of a class goes through C and back into Python. It is for values of which each tick makes some.
    """
    known, words, values = _written(cls)
    known |= {"_own": cls, "_open": opened(cls)}
    lines = ["made = _open()", *(f"made.{name} = {value}" for name, value in values.items()), "made.__class__ = _own"]
    if hasattr(cls, "__post_init__"):
        lines.append("made.__post_init__()")
    exec(f"def make({', '.join(words)}):\n " + "\n ".join([*lines, "return made"]), known)
    return known["make"]  # type: ignore[no-any-return]


def _constructor(cls: Any) -> Callable[..., None]:
    """The ``__init__`` of a class, which is written and put into its place."""
    known, words, values = _written(cls)
    lines = [f"_set(self, {name!r}, {value})" for name, value in values.items()]
    if len(lines) > _FEW and cls.__bases__ == (object,) and vars(cls).get("__slots__") == tuple(values):
        known |= {"_own": cls, "_open": opened(cls)}
        fast = [
            "_set(self, '__class__', _open)",
            *(f"self.{name} = {value}" for name, value in values.items()),
            "self.__class__ = _own",
        ]
        lines = ["if self.__class__ is _own:", *_indented(fast), "else:", *_indented(lines)]
    if hasattr(cls, "__post_init__"):
        lines.append("self.__post_init__()")
    exec(f"def __init__({', '.join(['self', *words])}):\n " + "\n ".join(lines or ["pass"]), known)
    init: Any = known["__init__"]
    init.__qualname__, init.__module__ = f"{cls.__qualname__}.__init__", cls.__module__
    init.__annotations__ = {one.name: one.type for one in dataclasses.fields(cls) if one.init} | {"return": None}
    cls.__init__ = init
    return init  # type: ignore[no-any-return]


def _written(cls: Any) -> tuple[dict[str, Any], list[str], dict[str, str]]:
    """What the text of a constructor knows, its parameters, and the values of the fields in these terms."""
    known: dict[str, Any] = {"_set": _set, "_unset": _UNSET}
    fields = sorted(
        dataclasses.fields(cls), key=lambda field: field.init and bool(field.kw_only)
    )  # those by name come last
    words: list[str] = []
    values: dict[str, str] = {}
    for field in fields:
        name, default, value = field.name, f"_default_{field.name}", field.name
        word = name
        if field.default_factory is not dataclasses.MISSING:
            known[default] = field.default_factory
            word, value = (
                f"{name}=_unset",
                f"{default}() if {name} is _unset else {name}" if field.init else f"{default}()",
            )
        elif field.default is not dataclasses.MISSING:
            known[default] = field.default
            word, value = f"{name}={default}", name if field.init else default
        elif not field.init:
            continue
        if field.init:
            words += ["*", word] if field.kw_only and "*" not in words else [word]
        values[name] = value
    return known, words, values


class _Signature:
    """The signature of a class, also for those that look at it before a value was made."""

    def __init__(self, cls: Any) -> None:
        self._cls, self._first = cls, vars(cls)["__init__"]

    def __get__(self, value: Any, owner: Any) -> inspect.Signature:
        init = next(vars(base)["__init__"] for base in owner.__mro__ if "__init__" in vars(base))
        if value is not None or init is not vars(self._cls)["__init__"]:
            raise AttributeError("__signature__")
        told = inspect.signature(_constructor(self._cls) if init is self._first else init)
        return told.replace(parameters=list(told.parameters.values())[1:])
