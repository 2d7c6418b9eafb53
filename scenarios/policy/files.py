"""From a path to a contract and its network: files of ours, and those that trainers export, as they are."""

import hashlib
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import yaml

from surefoot.errors import ParameterError
from surefoot.scenarios.policy import leapp, unitree
from surefoot.scenarios.policy.contract import KEY, Contract, contract_of
from surefoot.scenarios.policy.network import file_digest

_NAMES = ("contract.yaml", "walker.yaml", "policy.yaml", "deploy.yaml", "params/deploy.yaml")
"""Files that a folder is looked through for, in this order; then the only YAML file in it."""

_MOST_JOINTS = 1000
"""No robot has more."""

MOST_BYTES = 1 << 20
"""A longer file is no contract."""


@dataclass(frozen=True, slots=True)
class Files:
    """A policy on the disk.

    Attributes:
        path: of its contract, or of what stands for it.
        contract: what it says.
        network: path of its network.
    """

    path: Path
    contract: Contract
    network: Path

    def digest(self) -> str:
        """SHA-256 of contract and network."""
        return hashlib.sha256(self.path.read_bytes() + file_digest(self.network).encode()).hexdigest()


class _Loader(yaml.SafeLoader):
    """Reads plain YAML; objects of Python that exporters leave in it are nothing."""


_Loader.add_multi_constructor("tag:yaml.org,2002:python/", lambda *_: None)


def read(path: Path, joint_names: Sequence[str]) -> Files:
    """Read a policy.

    Args:
        path: of a contract, of Unitree's ``deploy.yaml``, of the YAML of LEAPP, or of a folder that holds one of them.
        joint_names: of the robot, in its order, which those of Unitree's motors is.

    Raises:
        ParameterError: it cannot be found or read.
    """
    file = _contract_in(path) if path.is_dir() else path
    values = _parsed(file)
    made = _reader(values)(values, file, joint_names)
    contract = contract_of(made, str(file))
    network = Path(contract.network)
    return Files(file, contract, network if network.is_absolute() else file.parent / network)


def digest_of(path: str) -> str:
    """Digest of a policy as it is on the disk now, of what is wrong with it if it cannot be read."""
    try:
        return read(Path(path), [f"joint {number}" for number in range(_MOST_JOINTS)]).digest()
    except (ParameterError, OSError) as error:
        return f"{type(error).__name__}: {error}"


def named_robot(path: Path) -> str | None:
    """The robot that a contract of ours names; None where it names none.

    Raises:
        ParameterError: it cannot be found or read.
    """
    values = _parsed(_contract_in(path) if path.is_dir() else path)
    robot = values.get("robot") if isinstance(values, dict) else None
    return robot if isinstance(robot, str) else None


def _reader(values: Any) -> Callable[[Any, Path, Sequence[str]], Any]:
    """The function that makes a contract of values, by what they are."""
    if isinstance(values, dict):
        for reader, keys in ((unitree.contract, unitree.KEYS), (leapp.contract, leapp.KEYS)):
            if all(key in values for key in keys):
                return reader
    return lambda values, *_: values


def _contract_in(folder: Path) -> Path:
    for name in _NAMES:
        if (folder / name).is_file():
            return folder / name
    found = sorted(folder.glob("*.yaml"))
    if len(found) == 1:
        return found[0]
    what = f"{folder}: {'several' if found else 'no'} contracts of a policy"
    raise ParameterError(KEY, what, f"give the path of one, or call it {_NAMES[0]}")


def _parsed(file: Path) -> Any:
    if file.suffix == ".onnx":
        right = f"write its contract first: surefoot policy new {file}"
        raise ParameterError(KEY, f"{file}: a network, of which nothing says what it observes", right)
    try:
        if file.stat().st_size > MOST_BYTES:
            raise ParameterError(KEY, f"{file}: too long for a contract", "give a YAML file")
        return yaml.load(file.read_text(encoding="utf-8"), _Loader)
    except FileNotFoundError:
        raise ParameterError(KEY, f"{file}: no such contract of a policy", "give the path of one") from None
    except (OSError, UnicodeDecodeError, yaml.YAMLError, RecursionError) as error:
        reason = " ".join(str(error).split())[:200]
        raise ParameterError(KEY, f"{file}: cannot be read, {reason}", "give a YAML file") from None
