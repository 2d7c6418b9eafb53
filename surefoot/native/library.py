"""The compiled kernels, bound to the memory of those that use them.

An object asks once, at its construction, whether there is a library, and binds a kernel to its arrays:

    kernels = library()
    run = kernels.bind("task_torso", Torso, ...) if kernels else None
"""

import ctypes
import logging
import math
import os
import re
from collections.abc import Callable, Mapping, Sequence
from functools import cache, partial
from itertools import accumulate
from typing import Any

import numpy as np
from numpy.typing import NDArray

from surefoot.native.build import FOLDER, LIBRARY, build, is_built
from surefoot.values import dataclass

VARIABLE = "SUREFOOT_NATIVE"
"""Environment variable that asks for plain Python where it is 0."""

_LOG = logging.getLogger(__name__)

_NUMBERS: Mapping[str, Any] = {"int64_t": ctypes.c_int64, "double": ctypes.c_double, "void": None}
_TYPES: Mapping[str, Any] = {"int64_t": np.dtype(np.int64), "double": np.dtype(np.float64)}
_STRUCT = re.compile(r"typedef struct \{(.*?)\} (\w+);", re.DOTALL)
_FIELD = re.compile(r"\s*(?:const )?(\w+) (\*?)(\w+)(?:\[(\d+)\])?;\n")
_FUNCTION = re.compile(r"^(\w+) (\w+)\(const (\w+) \*\w+((?:,\s+\w+ \w+)*)\);", re.MULTILINE)


@dataclass(frozen=True, slots=True)
class Field:
    """A field of a struct: the name of its type, whether it points there, and its length."""

    type: str
    pointer: bool
    length: int


@dataclass(frozen=True, slots=True)
class Bound:
    """A struct of the library with its fields filled in, and what it points to.

    Attributes:
        struct: in memory, as C sees it; its numbers may be set anew.
        kept: what must live as long.
    """

    struct: Any
    kept: tuple[Any, ...]

    def point(self, **others: Any) -> None:
        """Let fields point to other structs or arrays, as C sees them, which the caller keeps; this checks nothing."""
        for name, other in others.items():
            memory = other.struct if isinstance(other, Bound) else ctypes.c_char.from_buffer(other)
            setattr(self.struct, name, ctypes.addressof(memory))


class Block:
    """Arrays side by side in memory, which kernels fill, and of which one copy makes fresh ones.

    Args:
        shapes: of the arrays.

    Attributes:
        arrays: they themselves.
    """

    def __init__(self, *shapes: tuple[int, ...]) -> None:
        ends = list(accumulate(math.prod(shape) for shape in shapes))
        self._memory = np.zeros(ends[-1])
        self._parts = [(slice(end - math.prod(shape), end), shape) for end, shape in zip(ends, shapes, strict=True)]
        self.arrays = self._seen(self._memory)

    def copied(self) -> list[NDArray[np.float64]]:
        """They in fresh memory."""
        return self._seen(self._memory.copy())

    def kept(self) -> Callable[[], list[NDArray[np.float64]]]:
        """Tells them in fresh memory, as they are now."""
        return partial(self._seen, self._memory.copy())

    def _seen(self, memory: NDArray[np.float64]) -> list[NDArray[np.float64]]:
        return [memory[part].reshape(shape) for part, shape in self._parts]


class Library:
    """The functions of a compiled library on structs that Python fills.

    Args:
        handle: the loaded library.
        header: text of ``kernels.h``, which says what structs and functions there are.

    Attributes:
        structs: fields of each struct, by name.
        made: compiler, its version and its flags, such as ``gcc 12.2.0 -std=c11 -O3``; others give other bits.
    """

    def __init__(self, handle: ctypes.CDLL, header: str) -> None:
        self.made = ctypes.string_at(ctypes.addressof(ctypes.c_char.in_dll(handle, "surefoot_made"))).decode()
        self.structs: dict[str, dict[str, Field]] = {
            name: {
                field: Field(kind, bool(star), int(length or 1)) for kind, star, field, length in _FIELD.findall(body)
            }
            for body, name in _STRUCT.findall(header)
        }
        self._layouts = {name: _layout(name, fields) for name, fields in self.structs.items()}
        self._wanted = {
            struct: {name for name, field in fields.items() if field.pointer or field.length == 1}
            for struct, fields in self.structs.items()
        }
        self._functions = {
            name: (_function(handle, name, result, more), struct)
            for result, name, struct, more in _FUNCTION.findall(header)
        }

    def fill(self, struct: str, **values: Any) -> Bound:
        """A struct with the given fields: numbers, arrays that stay where they are, and other filled structs.

        Args:
            struct: its name.
            values: each of its fields but for arrays of numbers, which begin as zeros.

        Raises:
            TypeError: a field is missing, or is none of the struct's, or an array is not as C sees it.
        """
        fields = self.structs[struct]
        if not (values.keys() <= fields.keys() and (not values or self._wanted[struct] <= values.keys())):
            raise TypeError(f"{struct} has the fields {sorted(fields)}, not {sorted(values)}")
        made = self._layouts[struct]()
        for name, value in values.items():
            setattr(made, name, _address(struct, name, fields[name], value) if fields[name].pointer else value)
        return Bound(made, tuple(values.values()))

    def bind(self, function: str, bound: Bound | None = None, **values: Any) -> Callable[..., Any]:
        """A function on a struct, which is filled already or from these values; calls give its further numbers."""
        call, struct = self._functions[function]
        bound = bound or self.fill(struct, **values)
        if type(bound.struct) is not self._layouts[struct]:
            raise TypeError(f"{function} works on a {struct}, not on a {type(bound.struct).__name__}")
        return _Kernel(call, ctypes.addressof(bound.struct), bound=bound)

    def sequence(self, kernels: Sequence[Callable[[], Any]]) -> Callable[[], None]:
        """Kernels that take no numbers, one after another in one call; what is no such kernel is called by Python."""
        calls = self.calls(kernels)
        return partial(_call_all, tuple(kernels)) if calls is None else self.bind("calls_run", calls)

    def calls(self, kernels: Sequence[Callable[[], Any]]) -> Bound | None:
        """The same as a struct that other kernels take; None where one of them is called by Python."""
        bound = [kernel for kernel in kernels if isinstance(kernel, _Kernel) and len(kernel.call.argtypes) == 1]
        if len(bound) < len(kernels):
            return None
        functions = [ctypes.cast(kernel.call, ctypes.c_void_p).value for kernel in bound]
        calls = self.fill(
            "Calls",
            count=len(bound),
            functions=np.array(functions, dtype=np.int64),
            structs=np.array([kernel.args[0] for kernel in bound], dtype=np.int64),
        )
        # What the kernels are bound to must live as long.
        return Bound(calls.struct, (calls, *bound))

    def buffer(self, struct: str) -> tuple[Bound, Any]:
        """A struct of numbers alone, and its memory as an array, shape (numbers,)."""
        bound = self.fill(struct)
        count = sum(field.length for field in self.structs[struct].values())
        return bound, np.frombuffer(bound.struct, dtype=np.float64, count=count)


class _Kernel(partial[Any]):
    """A function with the address of its struct, which it keeps alive."""

    def __new__(cls, call: Any, address: int, bound: Bound) -> "_Kernel":
        made = super().__new__(cls, call, address)
        made.bound, made.call = bound, call
        return made

    bound: Bound
    call: Any


def _call_all(kernels: Sequence[Callable[[], Any]]) -> None:
    for kernel in kernels:
        kernel()


def library() -> Library | None:
    """The compiled kernels; None where plain Python is asked for, or where there is no library of these sources."""
    return None if os.environ.get(VARIABLE) == "0" else _loaded()


def is_missed() -> bool:
    """Whether there are no compiled kernels though nobody asked for plain Python."""
    return library() is None and os.environ.get(VARIABLE) != "0"


@cache
def _loaded() -> Library | None:
    """The library, loaded once. A checkout, which has the sources, makes a missing or stale one anew."""
    if not is_built():
        why = build() if (FOLDER.parents[1] / "pyproject.toml").exists() else "no checkout to build in"
        if why:
            if LIBRARY.exists():
                _LOG.warning("%s is of other sources and is not used: there is %s", LIBRARY.name, why)
            return None
    try:
        handle = ctypes.CDLL(str(LIBRARY))
    except OSError as error:
        _LOG.warning("%s is not used: %s", LIBRARY.name, error)
        return None
    return Library(handle, (FOLDER / "kernels.h").read_text(encoding="utf-8"))


def _layout(name: str, fields: Mapping[str, Field]) -> type[ctypes.Structure]:
    members = [
        (
            field_name,
            ctypes.c_void_p
            if field.pointer
            else _NUMBERS[field.type] * field.length
            if field.length > 1
            else _NUMBERS[field.type],
        )
        for field_name, field in fields.items()
    ]
    return type(name, (ctypes.Structure,), {"_fields_": members})


def _function(handle: ctypes.CDLL, name: str, result: str, more: str) -> Any:
    function = getattr(handle, name)
    numbers = [_NUMBERS[part.split()[0]] for part in more.split(",") if part.strip()]
    function.argtypes, function.restype = [ctypes.c_void_p, *numbers], _NUMBERS[result]
    return function


def _address(struct: str, name: str, field: Field, value: Any) -> int:
    if isinstance(value, Bound):
        right = type(value.struct).__name__ == field.type
        address = ctypes.addressof(value.struct)
    else:
        right = value.dtype == _TYPES.get(field.type) and value.flags.forc
        address = place_of(value)
    if not right:
        raise TypeError(f"{struct}.{name} points to {field.type}, which this is not: {value!r}")
    return int(address)


def place_of(array: NDArray[Any]) -> int:
    """Where the memory of an array begins, in a third of the time that its ``ctypes.data`` takes."""
    flags = array.flags
    if not (flags.writeable and flags.forc and array.size):
        return int(array.ctypes.data)
    memory: Any = array if flags.c_contiguous else array.T
    return ctypes.addressof(ctypes.c_char.from_buffer(memory))
