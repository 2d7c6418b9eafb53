"""The state of a simulation as a value: all that changes in its objects (see `surefoot.scenarios.run.reached`).

In the same simulation content goes back into the very objects. In another one of the same scenario, also of another
process, each goes into the object under the same path; what is there no more is made anew.
"""

import io
import pickle
import sys
from collections import deque
from collections.abc import Mapping
from dataclasses import dataclass
from types import CellType
from typing import Any

import numpy as np

from surefoot.engines.windowless import mujoco
from surefoot.errors import ParameterError
from surefoot.scenarios.run.reached import (
    ATOMS,
    Look,
    Reached,
    Variable,
    content_of,
    is_made_of_memory,
    is_view,
    kind_of,
    lasting,
    put,
    root_of,
)


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
        self._contents: list[Any] | None = [content_of(one) for one in self._kept()]
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
            put(found, content)
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
            put(found, content)

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
    kind = kind_of(found)
    return _Node(kind if kept or is_made_of_memory(kind) else object, named, kept)


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
        if found[number] is None and is_made_of_memory(node.kind):
            found[number] = node.kind(*(found[part] for part in node.parts.values()))
    return found


def _fits(node: _Node, there: Reached, place: int) -> bool:
    return not node.kept or kind_of(there.objects[place]) is node.kind


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
    return CellType() if kind is Variable else kind.__new__(kind)


class _Pickler(pickle.Pickler):
    """Writes contents, in which kept and fixed objects are named by their places."""

    def __init__(self, file: io.BytesIO, reached: Reached) -> None:
        super().__init__(file, protocol=5)
        self._reached = reached
        self._lasting = lasting(len(sys.modules))

    def persistent_id(self, found: Any) -> Any:
        """See `pickle`."""
        if isinstance(found, ATOMS):
            return None
        name, number = self._lasting.get(id(found)), self._reached.number.get(id(found))
        if name is not None or number is None:
            return name
        fixed = number in self._reached.fixed and "<locals>" in getattr(found, "__qualname__", "<locals>")
        return number if fixed or number in self._reached.kept else None

    def reducer_override(self, found: Any) -> Any:
        """See `pickle`; views look into their root again."""
        if is_view(type(found)):
            return memoryview, (np.asarray(found),)
        if isinstance(found, np.ndarray):
            root = self._reached.known(root_of(found))
            if root is not found and self._reached.number.get(id(root)) in self._reached.kept:
                offset = found.__array_interface__["data"][0] - root.__array_interface__["data"][0]
                return _looking, (root, offset, found.shape, found.strides, found.dtype.str)
        return NotImplemented


def _looking(root: Any, offset: int, shape: tuple[int, ...], strides: tuple[int, ...], kind: str) -> Any:
    """An array that looks into the memory of another one."""
    if (offset, shape, strides, kind) == (0, root.shape, root.strides, root.dtype.str):
        return root
    return np.asarray(Look(root, offset, shape, strides, kind))


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
