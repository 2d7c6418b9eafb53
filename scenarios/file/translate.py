"""Validation errors of the schema in words, and values without what was wrong."""

import copy
import itertools
from contextlib import suppress
from functools import partial
from typing import Any, cast, get_args, get_origin

from pydantic import BaseModel, ValidationError
from pydantic_core import ErrorDetails

from surefoot.scenarios.errors import Key, Problem, dotted, nearest
from surefoot.scenarios.file.criteria import Bound
from surefoot.scenarios.file.group import groups_in
from surefoot.scenarios.file.schema import Scenario, kind_key, kinds_with, model_of
from surefoot.scenarios.file.units import meant, unit_of

_EXPECTED = {
    "int_type": "give a whole number",
    "int_from_float": "give a whole number",
    "float_type": "give a number",
    "finite_number": "give a finite number",
    "bool_type": "give true or false",
    "string_type": "give a word",
    "tuple_type": "give a list",
    "model_type": "give a group of keys",
    "dict_type": "give a group of keys",
    "too_long": "give fewer elements",
    "too_short": "give more elements",
    "string_pattern_mismatch": "use letters, digits, '.', '_' and '-'",
    "string_too_long": "use fewer letters",
    "string_unicode": "use plain text",
}
_BOUNDS = {"greater_than": ("gt", "more than"), "greater_than_equal": ("ge", "at least")} | {
    "less_than": ("lt", "less than"),
    "less_than_equal": ("le", "at most"),
}


def problems_of(error: ValidationError, data: Any, root: type[BaseModel] = Scenario) -> list[Problem]:
    """Translate each validation error once, at the deepest path that exists in the data.

    Where the name of a kind is at fault, keys that nobody knows are left out: the kind may have them.
    """
    found: dict[Key, Problem] = {}
    details = error.errors(include_url=False)
    misnamed = {detail["loc"] for detail in details if detail["type"] == "literal_error"}
    for detail in details:
        group = detail["loc"][:-1]
        if detail["type"] == "extra_forbidden" and (*group, kind_key(_group(root, group, data))) in misnamed:
            continue
        problem = _problem(detail, data, root)
        found.setdefault(problem.key, problem)
    return list(found.values())


def without(data: Any, problems: list[Problem]) -> Any:
    """The data without what is at fault, so that the rest can still be checked; a list goes as a whole.

    The name of a kind takes with it the keys that only some kinds have. It is a copy, but for data without a fault.
    """
    rest = copy.deepcopy(data) if problems else data
    for problem in problems:
        path = list(itertools.takewhile(lambda part: isinstance(part, str), problem.key))
        path = path[:2] if path[:1] == ["criteria"] else path
        group = rest
        for part in path[:-1]:
            group = group.get(part) if isinstance(group, dict) else None
        if path and isinstance(group, dict):
            group.pop(path[-1], None)
            model = _group(Scenario, tuple(path[:-1]), rest)
            for name in group.keys() - model.model_fields.keys() if path[-1] == kind_key(model) else ():
                del group[name]
    return rest


def _problem(detail: ErrorDetails, data: Any, root: type[BaseModel]) -> Problem:
    key = _existing(detail["loc"], data)
    value, kind, context = detail["input"], detail["type"], detail.get("ctx", {})
    name = dotted(key) or "the file"
    if kind == "extra_forbidden":
        instead = partial(_instead, str(key[-1]), _group(root, key[:-1], data))
        return Problem(key, f"unknown key '{key[-1]}'", instead, at_key=True)
    if kind == "missing":
        missing = detail["loc"][-1]
        return Problem(key, f"{name} lacks element {missing}", f"give '{missing}'")
    if kind in _BOUNDS:
        bound, words = _BOUNDS[kind]
        unit = _unit(root, key, data)
        hint = meant(value, unit, abs(context[bound])) if abs(value) > abs(context[bound]) else ""
        return Problem(key, f"{name} is {_short(value)}", f"it must be {words} {context[bound]} {unit}".rstrip() + hint)
    if kind == "quantity":
        return Problem(key, f"{name} is {_short(value)}{context['named']}", context["right"])
    if kind == "literal_error":
        return Problem(key, f"{name} is {_short(value)}", f"it must be {context['expected']}")
    if kind == "value_error":
        what, _, right = str(context["error"]).partition("; ")
        return Problem(key, f"{name}: {what}", right)
    return Problem(
        key, f"{name} is {_short(value)}", _EXPECTED.get(kind, detail["msg"][:1].lower() + detail["msg"][1:])
    )


def _instead(name: str, model: type[BaseModel]) -> str:
    """The kind that has a key which its group has not got, or the key that was meant."""
    kinds = ", ".join(kinds_with(model, name))
    return f"it is a key of {kind_key(model)} {kinds}" if kinds else nearest(name, model.model_fields)


def _existing(location: tuple[str | int, ...], data: Any) -> Key:
    """The part of a location that leads to a value; union branches and missing keys are dropped."""
    key: Key = ()
    for part in location:
        try:
            data = data[part]
        except (KeyError, IndexError, TypeError):
            break
        key = (*key, part)
    return key


def _group(root: type[BaseModel], key: Key, data: Any) -> type[BaseModel]:
    """The group at a path into data; below a field of groups by name stands a name."""
    model: Any = root
    group: Any = root
    parts = iter(key)
    for part in parts:
        if part == "criteria":
            return Bound
        if not isinstance(part, int):
            annotation = model.model_fields[part].annotation
            group = next(groups_in(annotation))
            if any(get_origin(one) is dict for one in (annotation, *get_args(annotation))):
                next(parts, None)
        data = _inside(data, part)
        model = model_of(group, data)
    return cast("type[BaseModel]", model)


def _inside(data: Any, part: str | int) -> Any:
    """The value at a key or a number in data; None where there is none."""
    with suppress(LookupError, TypeError):
        return data[part]
    return None


def _unit(root: type[BaseModel], key: Key, data: Any) -> str:
    """SI unit of a key; empty when it has none."""
    place, last = [(place, part) for place, part in enumerate(key) if isinstance(part, str)][-1]
    field = _group(root, key[:place], data).model_fields.get(last)
    return unit_of(field.annotation, field.metadata) if field is not None else ""


def _short(value: Any) -> str:
    if value is None:
        return "null"
    text = str(value) if isinstance(value, bool | int | float) else repr(value)
    text = text.lower() if isinstance(value, bool) else text
    return text if len(text) <= 40 else text[:37] + "..."
