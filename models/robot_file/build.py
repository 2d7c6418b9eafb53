"""A robot file as a description: derived or from the cache, in its size, with options; and what was derived."""

from dataclasses import dataclass, replace
from functools import lru_cache
from pathlib import Path

from surefoot.models.belief import with_load
from surefoot.models.options import check_foot_size, check_payload, with_soles
from surefoot.models.robot_file import cache
from surefoot.models.robot_file.document import signature
from surefoot.models.robot_file.paths import resolve
from surefoot.models.robot_file.schema import RobotFile, read
from surefoot.models.similar import scaled
from surefoot.models.types import RobotDescription, RobotError, RobotOptions


@dataclass(frozen=True, slots=True)
class Explanation:
    """A robot, and how its description came to be.

    Attributes:
        description: the robot.
        derived: what was derived and from what, one line each.
        notes: what was altered or left out, or is to be known, one line each.
    """

    description: RobotDescription
    derived: tuple[str, ...]
    notes: tuple[str, ...]


def describe_file(path: Path, options: RobotOptions) -> RobotDescription:
    """The robot of a file with its options.

    Raises:
        RobotError: the file or its model cannot be used, or an option is out of range.
    """
    return _explained(path, options).description


def explain(path: Path) -> Explanation:
    """The robot of a file, with what of it was derived.

    Raises:
        RobotError: the file or its model cannot be used.
    """
    return _explained(path, RobotOptions())


def _explained(path: Path, options: RobotOptions) -> Explanation:
    file = read(path)
    if _is_name(file.model):
        return _similar(file, path, options)
    if file.feet is None:
        raise RobotError(("feet",), f"{path}: lacks feet", "give feet: {left: LINK, right: LINK}")
    found = _derived(file, path)
    description = scaled(found.description, file.scale)
    if options.foot_length is not None or options.foot_width is not None:
        check_foot_size(options)
        description = with_soles(description, options.foot_length, options.foot_width)
    return replace(found, description=_loaded(description, options))


def _is_name(model: str) -> bool:
    """Whether a model is that of a robot by its name, and no path."""
    return "/" not in model and "." not in model


def _similar(file: RobotFile, path: Path, options: RobotOptions) -> Explanation:
    """A robot that is known by name, in another size; its feet are chosen in the size that they then have."""
    from surefoot.models.registry import UnknownRobotError, describe

    given = sorted(file.model_fields_set - {"name", "model", "scale", "licence", "source"})
    if given:
        what = f"{path}: {given[0]} beside the model '{file.model}', which is the name of a robot"
        raise RobotError((given[0],), what, "give name, model and scale alone, or the path of a model")
    check_foot_size(options)
    length, width = (None if size is None else size / file.scale for size in (options.foot_length, options.foot_width))
    try:
        base = describe(file.model, RobotOptions(length, width))
    except UnknownRobotError as error:
        raise RobotError(("model",), f"{path}: model is '{file.model}'", f"{error}, or give a path") from None
    description = replace(scaled(base, file.scale), name=file.name)
    line = f"similar to {file.model}, {file.scale:g} times its size"
    return Explanation(_loaded(description, options), (line,), ())


def files_of(path: Path) -> tuple[tuple[str, Path | None], ...]:
    """All that a robot file is made of: each reference with the file that it means, None where there is none.

    Raises:
        RobotError: the file or its model cannot be read.
    """
    file = read(path)
    own = (("robot file", path.absolute()),)
    if _is_name(file.model):
        from surefoot.models.names import SHIPPED

        return (*own, *(files_of(SHIPPED[file.model]) if file.model in SHIPPED else ()))
    from surefoot.models.robot_file.files import read_document, srdf_of

    model = resolve(file.model, path.parent)
    return (*own, ("model", model), *read_document(model).references, ("srdf", srdf_of(file, model)))


def _derived(file: RobotFile, path: Path) -> Explanation:
    """At the size of the model; from the cache if nothing has changed since."""
    files = files_of(path)
    unchanged = tuple(() if place is None else signature(place) for _, place in files)
    return _unchanged(path, resolve(file.model, path.parent), files, unchanged)


@lru_cache(maxsize=16)
def _unchanged(
    path: Path, model: Path, files: tuple[tuple[str, Path | None], ...], _signatures: tuple[tuple[int, ...], ...]
) -> Explanation:
    """Once per process, as long as no file has another signature."""
    key = cache.digest(files)
    kept = cache.load(key)
    if kept is None:
        from surefoot.models.robot_file.derive import derive

        kept = derive(read(path), model)
        cache.store(key, *kept)
    return Explanation(*kept)


def _loaded(description: RobotDescription, options: RobotOptions) -> RobotDescription:
    """With the payload of the options.

    Raises:
        RobotError: the mass is out of range, or its body unknown.
    """
    check_payload(options, description.bodies)
    return with_load(description, options.payload_mass, options.payload_body) if options.payload_mass else description
