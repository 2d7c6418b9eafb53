"""A network in ONNX, run by onnxruntime on one thread, so that the same numbers come out again."""

import hashlib
from collections.abc import Mapping
from pathlib import Path
from types import ModuleType
from typing import Any, cast

import numpy as np
from numpy.typing import NDArray

from surefoot.errors import ParameterError
from surefoot.scenarios.policy.contract import KEY
from surefoot.version import install_command

MOST_BYTES = 1 << 30
"""A larger file is no network of a walker."""


class Network:
    """A network that is loaded.

    Args:
        path: of the file.

    Attributes:
        path: of the file.
        inputs: number of values of each input, by name; 0 where the file does not say.
        outputs: number of values of each output, by name; 0 where the file does not say.
        metadata: that the trainer has attached, by name.

    Raises:
        ParameterError: it cannot be read, or onnxruntime is not installed.
    """

    def __init__(self, path: Path) -> None:
        onnxruntime = _engine()
        options = onnxruntime.SessionOptions()
        options.intra_op_num_threads = options.inter_op_num_threads = 1
        options.execution_mode = onnxruntime.ExecutionMode.ORT_SEQUENTIAL
        options.log_severity_level = 3
        self.path = path
        if not path.is_file():
            raise ParameterError(KEY, f"{path}: no such network", "give the contract the path of an ONNX file")
        try:
            self._session = onnxruntime.InferenceSession(str(path), options, providers=["CPUExecutionProvider"])
        except Exception as error:  # classes of its own, which are exceptions and nothing else
            reason = str(error).splitlines()[0][:200]
            raise ParameterError(KEY, f"{path}: no network that can be run, {reason}", "give an ONNX file") from None
        self._types = {one.name: _TYPES.get(one.type, np.float32) for one in self._session.get_inputs()}
        self._shapes = {one.name: _shape(one.shape) for one in self._session.get_inputs()}
        self.inputs = {one.name: _count(one.shape) for one in self._session.get_inputs()}
        self.outputs = {one.name: _count(one.shape) for one in self._session.get_outputs()}
        self.metadata: Mapping[str, str] = dict(self._session.get_modelmeta().custom_metadata_map)
        self._names = list(self.outputs)

    def shaped(self, name: str, values: NDArray[np.float64]) -> NDArray[Any]:
        """Values of an input in its shape and type; of sizes that the file leaves open all are 1 but the last."""
        return values.astype(self._types[name]).reshape(self._shapes[name])

    def run(self, values: Mapping[str, NDArray[Any]]) -> dict[str, NDArray[Any]]:
        """The outputs, by name, of inputs in their shapes; their memory is their own, not that of the engine."""
        found = self._session.run(self._names, dict(values))
        return {name: np.array(output) for name, output in zip(self._names, found, strict=True)}


def file_digest(path: Path) -> str:
    """SHA-256 of a network's file, and of the weights beside it."""
    found = hashlib.sha256(path.read_bytes())
    beside = path.with_name(f"{path.name}.data")
    if beside.is_file():
        found.update(beside.read_bytes())
    return found.hexdigest()


def _engine() -> ModuleType:
    """The engine that runs networks."""
    try:
        import onnxruntime
    except ImportError:
        right = f"install it with: {install_command('policy')}"
        raise ParameterError(KEY, "a policy needs the package onnxruntime", right) from None
    return cast("ModuleType", onnxruntime)


_TYPES = {"tensor(float)": np.float32, "tensor(double)": np.float64, "tensor(int64)": np.int64}


def _count(shape: Any) -> int:
    """Number of values of a shape whose first size is that of a batch; 0 where another one is not known."""
    sizes = list(shape)
    if sizes and not isinstance(sizes[0], int):
        sizes[0] = 1
    return int(np.prod(sizes)) if all(isinstance(size, int) for size in sizes) else 0


def _shape(shape: Any) -> tuple[int, ...]:
    """The shape of an input with one for each size that is not known, but for the last one of several."""
    sizes = [size if isinstance(size, int) else 1 for size in shape]
    if not _count(shape):
        sizes = [1] * max(len(sizes) - 1, 0) + [-1]
    return tuple(sizes)
