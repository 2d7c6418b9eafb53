"""A robot file as a description: derived or from the cache, in its size, with options; and what was derived."""

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from functools import lru_cache
from pathlib import Path

from surefoot.models.belief import with_load
from surefoot.models.options import check_foot_size, check_payload, with_soles
from surefoot.models.robot_file import cache
from surefoot.models.robot_file.document import signature
from surefoot.models.robot_file.files import Originals, originals
from surefoot.models.robot_file.schema import RobotFile, read
from surefoot.models.similar import scaled
from surefoot.models.types import Explanation, RobotDescription, RobotError, RobotOptions, UnknownRobotError

ByName = Callable[[str, RobotOptions], RobotDescription]
"""Gives the robot of a name with options; raises `UnknownRobotError` where there is none."""


def explain(path: Path, options: RobotOptions, by_name: ByName) -> Explanation:
    """Describe the robot of a file with its options, and say what of it was derived.

    Args:
        path: of the robot file.
        options: of the robot.
        by_name: gives the robot that a file scales, whose model is a name.

    Raises:
        RobotError: the file or its model cannot be used, or an option is out of range.
    """
    file = read(path)
    if _is_name(file.model):
        return _similar(file, path, options, by_name)
    if file.feet is None:
        raise RobotError(("feet",), f"{path}: lacks feet", "give feet: {left: LINK, right: LINK}")
    found = _derived(originals(file, path.parent), path)
    description = scaled(found.description, file.scale)
    if options.foot_length is not None or options.foot_width is not None:
        check_foot_size(options)
        description = with_soles(description, options.foot_length, options.foot_width)
    return replace(found, description=_loaded(description, options))


def _is_name(model: str) -> bool:
    """Return true if a model is that of a robot by its name, and no path."""
    return "/" not in model and "." not in model


def _similar(file: RobotFile, path: Path, options: RobotOptions, by_name: ByName) -> Explanation:
    """A robot that is known by name, in another size; its feet are chosen in the size that they then have."""
    given = sorted(file.model_fields_set - {"name", "model", "scale", "licence", "source"})
    if given:
        what = f"{path}: {given[0]} beside the model '{file.model}', which is the name of a robot"
        raise RobotError((given[0],), what, "give name, model and scale alone, or the path of a model")
    check_foot_size(options)
    length, width = (None if size is None else size / file.scale for size in (options.foot_length, options.foot_width))
    try:
        base = by_name(file.model, RobotOptions(length, width))
    except UnknownRobotError as error:
        raise RobotError(("model",), f"{path}: model is '{file.model}'", f"{error}, or give a path") from None
    description = replace(scaled(base, file.scale), name=file.name)
    line = f"similar to {file.model}, {file.scale:g} times its size"
    return Explanation(_loaded(description, options), (line,), ())


def _derived(made_of: Originals, path: Path) -> Explanation:
    """At the size of the model; from the cache if nothing has changed since."""
    document = made_of.document
    files = (
        *(("robot file", path.absolute()), ("model", document.path)),
        *document.references,
        ("srdf", made_of.srdf),
    )
    signatures = tuple(() if place is None else signature(place) for _, place in files)
    return unchanged(_Unchanged(files, signatures, made_of))


@dataclass(frozen=True, slots=True)
class _Unchanged:
    """All that a robot is made of, which is the same as long as no file has another signature.

    Attributes:
        files: each reference with the file that it means, None where there is none.
        signatures: of these files.
        originals: what was read of them.
    """

    files: tuple[tuple[str, Path | None], ...]
    signatures: tuple[tuple[int, ...], ...]
    originals: Originals = field(compare=False)


@lru_cache(maxsize=16)
def unchanged(made_of: _Unchanged) -> Explanation:
    """The description of what has not changed, made or read once per process."""
    key = cache.digest(made_of.files)
    kept = cache.load(key)
    if kept is None:
        from surefoot.models.robot_file.derive import derive

        kept = derive(made_of.originals)
        cache.store(key, *kept)
    return Explanation(*kept)


def _loaded(description: RobotDescription, options: RobotOptions) -> RobotDescription:
    """The robot with the payload of the options.

    Raises:
        RobotError: the mass is out of range, or its body unknown.
    """
    check_payload(options, description.bodies)
    return with_load(description, options.payload_mass, options.payload_body) if options.payload_mass else description
