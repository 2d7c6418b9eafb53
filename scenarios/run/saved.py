"""The state of a simulation as a value: all that changes in its objects, by the protocol of pickle.

Whatever can be reached from the closed loop is looked through once. What does not change for a walk stays where it is:
the walk itself, robot models, scratch memory of libraries, records. Of all else the content is kept: of arrays, lists
and dictionaries, of random generators, of MuJoCo's data, and of
objects what pickle would keep of them, compiled ones too.

In the same simulation content goes back into the very objects. In another one of the same scenario, also of another
process, each goes into the object under the same path; what is there no more is made anew.
"""

import copy
import io
import pickle
import sys
from collections import deque
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, fields, is_dataclass
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

_ATOMS = (int, float, complex, str, bytes, type(None), Enum, np.generic, np.dtype, type, ModuleType, slice, range)
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
                if isinstance(part, _ATOMS):
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
            root = _root(found)
            if root is not found or found.base is not None:
                self.exported.add(id(root))
            if root is found:
                self.kept[len(self.parts)] = None
            else:
                yield "base", root
        elif _is_view(kind):
            root = self.known(_root(np.asarray(found)))
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
        elif _is_made_of_memory(kind):
            self.fixed.add(len(self.parts))
            parts = found.__reduce__()[1]
            self.exported |= {id(_root(part)) for part in parts if isinstance(part, np.ndarray)}
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


class _Variable:
    """Stands in a state for the class of a function's variable, which pickle cannot name."""


def _kind(found: Any) -> type:
    """The class of an object, as a state names it."""
    return _Variable if isinstance(found, CellType) else type(found)


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


def _is_view(kind: type) -> bool:
    """Return true if something is a compiled object's look into an array."""
    return kind.__name__ in ("_memoryviewslice", "memoryview")


def _is_made_of_memory(kind: type) -> bool:
    """Return true if a compiled object says by itself what pickle keeps of it: arrays that stay where they are."""
    own = "__reduce__" in vars(kind) and "__setstate_cython__" not in dir(kind)
    return own and kind.__module__.startswith("surefoot") and not kind.__dictoffset__


def _root(array: np.ndarray[Any, Any]) -> np.ndarray[Any, Any]:
    """The array into whose memory one looks."""
    while True:
        base: Any = array.base
        while isinstance(base, memoryview | _Look) or _is_view(type(base)):
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


def _content(found: Any) -> Any:
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


def _put(found: Any, content: Any) -> None:
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


@dataclass(frozen=True, slots=True)
class _Node:
    """An object of a state: its class, the numbers of its parts, and whether it is kept and others look into it.

    Attributes:
        kind: its class.
        parts: by their keys.
        kept: whether its content is.
        array: of an array its shape and type.
        exported: of an array, whether somebody looks into it.
        foreign: of an array, whether its memory is that of a library.
    """

    kind: type
    parts: dict[Any, int]
    kept: bool
    array: tuple[Any, ...] = ()
    exported: bool = False
    foreign: bool = False


_Packed = tuple[tuple[_Node, ...], bytes]
"""Nodes of a state, and their contents."""


class State:
    """The state of a simulation between two control ticks; it can be pickled.

    Args:
        root: the closed loop.
        of: text of the scenario, and what made it, which have to be the same where it is put back.
        time: of the last tick, None before the first [s].
        owner: stands for the simulation whose state it is.

    Attributes:
        of: text of the scenario, and what made it.
        time: of the last tick, None before the first [s].

    Raises:
        ParameterError: a part holds something of which nobody knows what its state is.
    """

    def __init__(self, root: object, of: Mapping[str, str], time: float | None = None, owner: object = None) -> None:
        self.of, self.time, self._owner = dict(of), time, owner
        self._reached: Reached | None = Reached(root)
        self._root: Any = root
        self._contents: list[Any] | None = [_content(one) for one in self._kept()]
        self._packed: _Packed | None = None

    def _kept(self) -> list[Any]:
        """The objects whose content is kept."""
        reached = self._reached
        assert reached is not None
        return [reached.objects[number] for number in reached.kept]

    def is_of(self, owner: object) -> bool:
        """Return true if it is a state of this very simulation, in this process."""
        return self._owner is owner

    def put_back(self) -> Any:
        """Give the objects of the loop that it was taken of their content of then; gives the loop."""
        assert self._contents is not None
        for found, content in zip(self._kept(), self._contents, strict=True):
            _put(found, content)
        return self._root

    def put_into(self, root: object) -> None:
        """Give the objects of another loop of the same scenario this state.

        Raises:
            ParameterError: something is missing there.
        """
        nodes, pickled = self._packed or self._pickled()
        objects = _matched(nodes, root)
        contents = _Unpickler(io.BytesIO(pickled), objects).load()
        kept = (found for found, node in zip(objects, nodes, strict=True) if node.kept)
        for found, content in zip(kept, contents, strict=True):
            _put(found, content)

    def _pickled(self) -> _Packed:
        reached = self._reached
        assert reached is not None
        file = io.BytesIO()
        nodes = tuple(_node(number, number in reached.kept, reached) for number in range(len(reached.objects)))
        _Pickler(file, reached).dump(self._contents)
        return nodes, file.getvalue()

    def __reduce__(self) -> tuple[Any, ...]:
        """See `pickle`: of the objects themselves another process has its own."""
        return _unpickled, (self.of, self.time, self._packed or self._pickled())

    def __repr__(self) -> str:
        """The time of the state, in words."""
        return "<State before the first tick>" if self.time is None else f"<State after the tick at {self.time:.3f} s>"


def _unpickled(of: Mapping[str, str], time: float | None, packed: _Packed) -> State:
    state = State.__new__(State)
    state.of, state.time, state._packed = dict(of), time, packed
    state._reached, state._contents, state._root, state._owner = None, None, None, None
    return state


def _node(number: int, kept: bool, reached: Reached) -> _Node:
    found, parts = reached.objects[number], reached.parts[number]
    named = {key: part for key, part in parts.items() if isinstance(key, int | str)}
    if isinstance(found, np.ndarray):
        shape, exported = (found.shape, found.dtype), id(found) in reached.exported
        return _Node(np.ndarray, named, kept, shape, exported, kept and found.base is not None)
    kind = _kind(found)
    return _Node(kind if kept or _is_made_of_memory(kind) else object, named, kept)


def _matched(nodes: tuple[_Node, ...], root: object) -> list[Any]:
    """The objects of another loop that have the places of a state's; None for those that are not there.

    One that is kept and not there is made. So is an array that nobody looks into: the one that is there may be a
    constant, or somebody's value.
    """
    there = Reached(root)
    places, taken, waiting = {0: 0}, {0}, deque([0])
    while waiting:
        number = waiting.popleft()
        known = there.parts[places[number]]
        for key, part in nodes[number].parts.items():
            place = known.get(key)
            if part not in places and place is not None and place not in taken and _fits(nodes[part], there, place):
                places[part] = place
                taken.add(place)
                waiting.append(part)
    found = [_object_for(node, places.get(number), there) for number, node in enumerate(nodes)]
    for number, node in enumerate(nodes):
        if found[number] is None and _is_made_of_memory(node.kind):
            found[number] = node.kind(*(found[part] for part in node.parts.values()))
    return found


def _fits(node: _Node, there: Reached, place: int) -> bool:
    return not node.kept or _kind(there.objects[place]) is node.kind


def _object_for(node: _Node, place: int | None, there: Reached) -> Any:
    kind = node.kind
    found: Any = None if place is None else there.objects[place]
    if not node.kept:
        return found
    usable = found is not None and place in there.kept
    if kind is np.ndarray:
        same = usable and (found.shape, found.dtype) == node.array
        if node.foreign and not same:
            what = "a state with a look into the memory of a library that is not there"
            raise ParameterError(("state",), what, "put it into a simulation of the same scenario and parts")
        in_place = same and (node.foreign or (node.exported and found.flags.writeable))
        return found if in_place else np.empty(*node.array)
    if usable:
        return found
    if issubclass(kind, mujoco.MjData | np.random.Generator | np.random.BitGenerator):
        what = f"a state with a {kind.__name__} that is not there"
        raise ParameterError(("state",), what, "put it into a simulation of the same scenario and parts")
    return CellType() if kind is _Variable else kind.__new__(kind)


@lru_cache(maxsize=1)
def lasting(_modules: int) -> Mapping[int, tuple[str, str]]:
    """Modules and names of the values that modules of Surefoot have by name, by identity; they stay.

    Looked for again when modules were imported.
    """
    found: dict[int, tuple[str, str]] = {}
    for name, module in sorted(sys.modules.items()):
        if name.startswith("surefoot") and module is not None:
            for word, value in vars(module).items():
                if not isinstance(value, (*_ATOMS, FunctionType)) and not (type(value) is tuple and not value):
                    found.setdefault(id(value), (name, word))
    return found


class _Pickler(pickle.Pickler):
    """Writes contents, in which kept and fixed objects are named by their places."""

    def __init__(self, file: io.BytesIO, reached: Reached) -> None:
        super().__init__(file, protocol=5)
        self._reached = reached
        self._lasting = lasting(len(sys.modules))

    def persistent_id(self, found: Any) -> Any:
        """See `pickle`."""
        if isinstance(found, _ATOMS):
            return None
        name, number = self._lasting.get(id(found)), self._reached.number.get(id(found))
        if name is not None or number is None:
            return name
        fixed = number in self._reached.fixed and "<locals>" in getattr(found, "__qualname__", "<locals>")
        return number if fixed or number in self._reached.kept else None

    def reducer_override(self, found: Any) -> Any:
        """See `pickle`; views look into their root again."""
        if _is_view(type(found)):
            return memoryview, (np.asarray(found),)
        if isinstance(found, np.ndarray):
            root = self._reached.known(_root(found))
            if root is not found and self._reached.number.get(id(root)) in self._reached.kept:
                offset = found.__array_interface__["data"][0] - root.__array_interface__["data"][0]
                return _looking, (root, offset, found.shape, found.strides, found.dtype.str)
        return NotImplemented


def _looking(root: Any, offset: int, shape: tuple[int, ...], strides: tuple[int, ...], kind: str) -> Any:
    """An array that looks into the memory of another one."""
    if (offset, shape, strides, kind) == (0, root.shape, root.strides, root.dtype.str):
        return root
    return np.asarray(_Look(root, offset, shape, strides, kind))


class _Look:
    """Description of an array that looks into another one, for numpy, whatever the order of its numbers."""

    def __init__(self, root: Any, offset: int, shape: tuple[int, ...], strides: tuple[int, ...], kind: str) -> None:
        self.base = root
        place = root.__array_interface__["data"][0] + offset
        self.__array_interface__ = {
            "version": 3, "data": (place, False), "shape": shape, "strides": strides, "typestr": kind
        }  # fmt: skip


class _Unpickler(pickle.Unpickler):
    """Reads contents for the objects of another loop.

    Args:
        file: that is read.
        objects: that have the places of the state's; None for what is not there.
    """

    def __init__(self, file: io.BytesIO, objects: list[Any]) -> None:
        super().__init__(file)
        self._objects = objects

    def persistent_load(self, key: Any) -> Any:
        """See `pickle`."""
        if isinstance(key, tuple):
            return getattr(sys.modules[key[0]], key[1])
        found = self._objects[key]
        if found is None:
            what = "a state with a part that is not there"
            raise ParameterError(("state",), what, "put it into a simulation of the same scenario and parts")
        return found
