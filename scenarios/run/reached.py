"""All that can be reached from the closed loop, and the content of each object, by the protocol of pickle.

What does not change for a walk stays where it is: the walk itself, robot models, scratch memory of libraries, records.
Of all else the content is kept: of arrays, lists and dictionaries, of random generators, of MuJoCo's data, and of
objects what pickle would keep of them, compiled ones too.
"""

import copy
import pickle
import sys
from collections import deque
from collections.abc import Iterator, Mapping
from dataclasses import fields, is_dataclass
from enum import Enum
from functools import lru_cache, partial
from types import BuiltinFunctionType, CellType, FunctionType, MappingProxyType, MethodType, ModuleType
from typing import Any

import numpy as np
from pydantic import BaseModel

from surefoot.engines.windowless import mujoco
from surefoot.errors import ParameterError
from surefoot.models.types import RobotDescription
from surefoot.parts.guard import Guard
from surefoot.parts.plugins import Registry
from surefoot.planner.walk_model import WalkModel
from surefoot.scenarios.log import LogWriter
from surefoot.scenarios.setup.walk import Walk

ATOMS = (int, float, complex, str, bytes, type(None), Enum, np.generic, np.dtype, type, ModuleType, slice, range)
"""Values without parts."""

_FIXED = (
    Walk, WalkModel, RobotDescription, BaseModel, Registry, Guard, LogWriter, mujoco.MjModel, FunctionType, partial,
    memoryview,
)  # fmt: skip
"""Classes whose objects stay the same for a walk, or are scratch memory of it."""

_FIXED_MODULES = ("surefoot.scenarios.record", "surefoot.scenarios.log")
"""Modules that write the log, which hold nothing that a run goes by."""

_LIBRARIES = frozenset(("pinocchio", "coal", "mujoco", "onnxruntime", "mcap"))
"""Packages whose objects are models and scratch memory, but for MuJoCo's data, the state of the physics."""

_RANDOM = (np.random.Generator, np.random.BitGenerator)


class Reached:
    """All objects that can be reached from one, in the order in which they are met.

    Args:
        root: from which one goes.

    Attributes:
        objects: that were met.
        number: of each in that order, by identity.
        parts: of each, by their keys, the numbers of its parts.
        kept: numbers of those whose content may change.
        fixed: numbers of what stays.
        exported: identities of arrays that compiled objects or other arrays look into.

    Raises:
        ParameterError: there is something of which nobody knows what its state is.
    """

    def __init__(self, root: object) -> None:
        self.objects: list[Any] = [root]
        self.number: dict[int, int] = {id(root): 0}
        self.parts: list[dict[Any, int]] = []
        self.kept: dict[int, None] = {}  # in order
        self.fixed: set[int] = set()
        self.exported: set[int] = set()
        self._lasting = lasting(len(sys.modules))
        self._foreign: dict[Any, np.ndarray[Any, Any]] = {}
        while len(self.parts) < len(self.objects):
            met: dict[Any, int] = {}
            for key, part in self._parts(self.objects[len(self.parts)]):
                if isinstance(part, ATOMS):
                    continue
                if id(part) not in self.number:
                    self.number[id(part)] = len(self.objects)
                    self.objects.append(part)
                met[key] = self.number[id(part)]
            self.parts.append(met)

    def known(self, root: np.ndarray[Any, Any]) -> np.ndarray[Any, Any]:
        """The array under which memory of a library was met first, of which each look makes a new one."""
        return self._foreign.setdefault((root.__array_interface__["data"][0], root.shape, root.strides), root)

    def _parts(self, found: Any) -> Iterator[tuple[Any, Any]]:
        """Parts of an object by their places in it."""
        kind = type(found)
        if id(found) in self._lasting or _stays(found):
            self.fixed.add(len(self.parts))
            yield from _closed_over(found)
        elif isinstance(found, CellType):
            self.kept[len(self.parts)] = None
            yield from enumerate(_cell(found))
        elif isinstance(found, np.ndarray):
            root = root_of(found)
            if root is not found or not root.flags.owndata:
                self.exported.add(id(root))
            if root is found:
                self.kept[len(self.parts)] = None
            else:
                yield "base", root
        elif is_view(kind):
            root = self.known(root_of(np.asarray(found)))
            self.exported.add(id(root))
            yield "memory", root
        elif isinstance(found, tuple | frozenset):
            yield from enumerate(found)
        elif isinstance(found, MethodType | BuiltinFunctionType):
            yield "self", found.__self__
        elif isinstance(found, MappingProxyType):
            yield from found.items()
        elif is_dataclass(kind) and kind.__dataclass_params__.frozen:  # type: ignore[attr-defined]
            yield from ((one.name, getattr(found, one.name)) for one in fields(kind))
        elif isinstance(found, list | deque | set):
            self.kept[len(self.parts)] = None
            yield from enumerate(found)
        elif isinstance(found, dict):
            self.kept[len(self.parts)] = None
            yield from found.items()
        elif isinstance(found, (*_RANDOM, mujoco.MjData)):
            self.kept[len(self.parts)] = None
        elif is_made_of_memory(kind):
            self.fixed.add(len(self.parts))
            parts = found.__reduce__()[1]
            self.exported |= {id(root_of(part)) for part in parts if isinstance(part, np.ndarray)}
            yield from enumerate(parts)
        else:
            self.kept[len(self.parts)] = None
            state = _state(found)
            yield from enumerate(state) if isinstance(state, tuple) else state.items()


def _closed_over(found: Any) -> Iterator[tuple[Any, Any]]:
    """Parts of what can be called and stays: variables of the function around it, values that it is given."""
    if isinstance(found, FunctionType):
        yield from enumerate(found.__closure__ or ())
    elif isinstance(found, partial):
        yield from (("func", found.func), ("args", found.args), ("keywords", found.keywords))


class Variable:
    """Stands in a state for the class of a function's variable, which pickle cannot name."""


def kind_of(found: Any) -> type:
    """The class of an object, as a state names it."""
    return Variable if isinstance(found, CellType) else type(found)


def _cell(found: CellType) -> list[Any]:
    """The value of a function's variable, if it has one yet."""
    try:
        return [found.cell_contents]
    except ValueError:
        return []


def _stays(found: Any) -> bool:
    module = type(found).__module__ or ""
    library = module.partition(".")[0] in _LIBRARIES and not isinstance(found, mujoco.MjData)
    named = type(found).__name__ in ("PyCapsule", "cython_function_or_method")
    return library or named or isinstance(found, _FIXED) or module.startswith(_FIXED_MODULES)


def is_view(kind: type) -> bool:
    """Return true if something is a compiled object's look into an array."""
    return kind.__name__ in ("_memoryviewslice", "memoryview")


def is_made_of_memory(kind: type) -> bool:
    """Return true if a compiled object says by itself what pickle keeps of it: arrays that stay where they are."""
    own = "__reduce__" in vars(kind) and "__setstate_cython__" not in dir(kind)
    return own and kind.__module__.startswith("surefoot") and not kind.__dictoffset__


def root_of(array: np.ndarray[Any, Any]) -> np.ndarray[Any, Any]:
    """The array into whose memory one looks."""
    while True:
        base: Any = array.base
        while isinstance(base, memoryview | Look) or is_view(type(base)):
            base = base.obj if isinstance(base, memoryview) else base.base
        if not isinstance(base, np.ndarray):
            return array
        array = base


def _state(found: Any) -> Any:
    """Content that pickle would keep of an object: of a compiled one a tuple, of others a dictionary."""
    kind = type(found)
    if hasattr(kind, "__reduce_cython__"):
        reduced = found.__reduce_cython__()
        return reduced[2] if len(reduced) > 2 else reduced[1][2]
    own = getattr(found, "__dict__", None)
    names = [name for base in kind.__mro__ for name in _slots(base)]
    if (own is None and not names) or _hides(found):
        what = f"the state of a {kind.__module__}.{kind.__qualname__}, which nobody knows"
        raise ParameterError(("state",), what, "save a simulation without the part that holds it")
    return {**(own or {}), **{name: getattr(found, name) for name in names if hasattr(found, name)}}


def _hides(found: Any) -> bool:
    """Return true if a class in C under an object keeps what Python cannot see, by the judgement of pickle.

    Classes of Surefoot hide nothing but scratch memory of libraries.
    """
    if type(found).__module__.partition(".")[0] == "surefoot":
        return False
    try:
        object.__reduce_ex__(found, 2)
    except (TypeError, pickle.PicklingError):
        return True
    return False


def _slots(kind: type) -> tuple[str, ...]:
    slots = kind.__dict__.get("__slots__", ())
    named = (slots,) if isinstance(slots, str) else tuple(slots)
    return tuple(name for name in named if name not in ("__dict__", "__weakref__"))


def content_of(found: Any) -> Any:
    """A copy of what an object holds, which does not change with it; parts that are kept themselves are not copied."""
    if isinstance(found, np.ndarray | mujoco.MjData):
        return copy.copy(found)
    if isinstance(found, CellType):
        return _cell(found)
    if isinstance(found, np.random.Generator):
        return found.bit_generator.state
    if isinstance(found, np.random.BitGenerator):
        return found.state
    if isinstance(found, list | deque | set):
        return list(found)
    if isinstance(found, dict):
        return dict(found)
    return _state(found)


def put(found: Any, content: Any) -> None:
    """Give an object the content that it had."""
    if isinstance(found, np.ndarray):
        if found.flags.writeable:
            np.copyto(found, content)
    elif isinstance(found, CellType):
        if content:
            found.cell_contents = content[0]
    elif isinstance(found, mujoco.MjData):
        mujoco.mj_copyData(found, content.model, content)
    elif isinstance(found, np.random.Generator):
        found.bit_generator.state = content
    elif isinstance(found, np.random.BitGenerator):
        found.state = content
    elif isinstance(found, list | deque):
        found.clear()
        found.extend(content)
    elif isinstance(found, set | dict):
        found.clear()
        found.update(content)
    elif isinstance(content, tuple):
        found.__setstate_cython__(content)
    else:
        slots = {name for base in type(found).__mro__ for name in _slots(base)}
        for name in content.keys() & slots:
            getattr(type(found), name).__set__(found, content[name])
        own = getattr(found, "__dict__", None)
        if own is not None:
            own.clear()
            own.update({name: value for name, value in content.items() if name not in slots})


@lru_cache(maxsize=1)
def lasting(_modules: int) -> Mapping[int, tuple[str, str]]:
    """Modules and names of the values that modules of Surefoot have by name, by identity; they stay.

    Looked for again when modules were imported.
    """
    found: dict[int, tuple[str, str]] = {}
    for name, module in sorted(sys.modules.items()):
        if name.startswith("surefoot") and module is not None:
            for word, value in vars(module).items():
                if not isinstance(value, (*ATOMS, FunctionType)) and not (type(value) is tuple and not value):
                    found.setdefault(id(value), (name, word))
    return found


class Look:
    """Description of an array that looks into another one, for numpy, whatever the order of its numbers."""

    def __init__(self, root: Any, offset: int, shape: tuple[int, ...], strides: tuple[int, ...], kind: str) -> None:
        self.base = root
        place = root.__array_interface__["data"][0] + offset
        self.__array_interface__ = {
            "version": 3, "data": (place, False), "shape": shape, "strides": strides, "typestr": kind
        }  # fmt: skip
