"""Public names say what they are: every one has a docstring, every field a meaning, arrays a shape, errors a name."""

import ast
import inspect
import re
import textwrap
from dataclasses import dataclass, fields, is_dataclass
from importlib import import_module
from pathlib import Path

import numpy as np
import pytest

pytestmark = pytest.mark.unit

FACES = ("surefoot", "surefoot.planner", "surefoot.wbc", "surefoot.sim", "surefoot.models")


def public():
    """Classes and functions that the faces name, each once."""
    found = {}
    for face in FACES:
        module = import_module(face)
        for name in module.__all__:
            thing = getattr(module, name)
            if inspect.isclass(thing) or inspect.isfunction(thing):
                found.setdefault(id(thing), (name, thing))
    return sorted(found.values(), key=lambda one: one[0])


PUBLIC = public()
CLASSES = [(name, thing) for name, thing in PUBLIC if inspect.isclass(thing)]


def callables(name, thing):
    """The thing, or what is public of a class and of this package."""
    if not inspect.isclass(thing):
        return [(name, thing)]
    own = [(f"{name}.{key}", value) for key, value in vars(thing).items() if not key.startswith("_")]
    unwrapped = [(key, getattr(value, "__func__", getattr(value, "fget", value))) for key, value in own]
    return [(key, value) for key, value in unwrapped if inspect.isfunction(value)]


def entries(text):
    """Names and meanings in the sections Attributes and Args of a docstring."""
    found = re.findall(r"(?m)^    (\w+(?:, \w+)*)(?: \([^)]*\))?: (.*(?:\n {5,}.*)*)", text)
    return {name: meaning for names, meaning in found for name in names.split(", ")}


def raised(function):
    """Names of the errors that a function raises by itself."""
    tree = ast.parse(textwrap.dedent(inspect.getsource(function)))
    calls = [node.exc for node in ast.walk(tree) if isinstance(node, ast.Raise) and isinstance(node.exc, ast.Call)]
    return {call.func.id for call in calls if isinstance(call.func, ast.Name)} - {"NotImplementedError"}


@pytest.mark.parametrize(("name", "thing"), PUBLIC, ids=[name for name, _ in PUBLIC])
def test_it_says_what_it_is(name, thing):
    assert inspect.getdoc(thing)
    for part, function in callables(name, thing):
        assert inspect.getdoc(function), part


@pytest.mark.parametrize(("name", "thing"), PUBLIC, ids=[name for name, _ in PUBLIC])
def test_it_says_what_it_raises(name, thing):
    told = inspect.getdoc(thing) or ""
    for part, function in callables(name, thing):
        text = told + (inspect.getdoc(function) or "")
        for error in raised(function):
            assert error in text, f"{part} raises {error}"


DATA = [(name, thing) for name, thing in CLASSES if is_dataclass(thing)]


@pytest.mark.parametrize(("name", "thing"), DATA, ids=[name for name, _ in DATA])
def test_every_field_has_a_meaning_and_every_array_a_shape(name, thing):
    assert not list(fields_without_meaning(thing)), name
    assert not list(fields_without_shape(thing)), name


def fields_without_meaning(thing):
    told = entries(inspect.getdoc(thing))
    for field in fields(thing):
        if not field.name.startswith("_") and not (told.get(field.name) or field.metadata.get("doc")):
            yield field.name


def fields_without_shape(thing):
    """Arrays, and tuples and mappings of them; the head of the class may say the shape of each."""
    told, head = entries(inspect.getdoc(thing)), inspect.getdoc(thing).split("\n\n")[0]
    for field in fields(thing):
        meaning = (told.get(field.name) or field.metadata.get("doc", "")) + (head if "each" in head else "")
        if not field.name.startswith("_") and ARRAY.search(str(field.type)) and not re.search(SHAPE, meaning):
            yield field.name


UNIT = r"\[[^\[\]]*\]"
"""Unit in a docstring; a pure number has [-], and what is of many units [SI]."""
NUMBER = re.compile(r"\bfloat\b|\bArray\b|NDArray|ndarray")


@pytest.mark.parametrize(("name", "thing"), DATA, ids=[name for name, _ in DATA])
def test_every_field_that_is_a_number_has_a_unit(name, thing):
    told = entries(inspect.getdoc(thing))
    for field in fields(thing):
        if not field.name.startswith("_") and NUMBER.search(str(field.type)):
            unit = field.metadata.get("unit") or re.search(UNIT, told.get(field.name) or field.metadata.get("doc", ""))
            assert unit, f"{name}.{field.name}"


ARRAY = re.compile(r"\bArray\b|NDArray|ndarray")
FLOAT = re.compile(r"\bfloat(?:64)?\b|\bArray\b")
SHAPE = r"[Ss]hapes? \(|\([0-9a-z_]+(?:, [0-9a-z_]*)+\)|of `"
"""Shape in a docstring: said, written behind a name, or that of what is named."""


def silent_about(said, kind, function, told):
    """Arguments and the return of a kind of which a function does not say this; told of its class by attribute."""
    text, signature = inspect.getdoc(function) or "", inspect.signature(function)
    own, head = entries(text), re.split(r"\n(?:Args|Returns|Raises):", text)[0]
    for argument in signature.parameters.values():
        meaning = own.get(argument.name) or told.get(argument.name) or head
        if kind.search(str(argument.annotation)) and not re.search(said, meaning):
            yield argument.name
    returns = "".join(re.findall(r"(?s)\nReturns:(.*?)(?=\n\S|$)", text))
    if kind.search(str(signature.return_annotation)) and not re.search(said, head + returns):
        yield "return"


@pytest.mark.parametrize(("name", "thing"), CLASSES, ids=[name for name, _ in CLASSES])
def test_every_array_that_a_class_is_made_of_has_a_shape_and_every_number_a_unit(name, thing):
    """A class that is no dataclass says so itself or in its `__init__`."""
    made = vars(thing).get("__init__")
    if is_dataclass(thing) or not inspect.isfunction(made):
        return
    told = entries(inspect.getdoc(thing)) | entries(inspect.getdoc(made) or "")
    for argument in inspect.signature(made).parameters.values():
        meaning = told.get(argument.name, "")
        if ARRAY.search(str(argument.annotation)):
            assert re.search(SHAPE, meaning), f"{name}: {argument.name}"
        if FLOAT.search(str(argument.annotation)):
            assert re.search(UNIT, meaning), f"{name}: {argument.name}"


@pytest.mark.parametrize(("said", "kind"), [(UNIT, NUMBER), (SHAPE, ARRAY)], ids=["unit", "shape"])
@pytest.mark.parametrize(("name", "thing"), PUBLIC, ids=[name for name, _ in PUBLIC])
def test_every_argument_and_return_that_is_a_number_has_a_unit_and_every_array_a_shape(name, thing, said, kind):
    told = entries(inspect.getdoc(thing)) if inspect.isclass(thing) else {}
    for part, function in callables(name, thing):
        assert not list(silent_about(said, kind, function, told)), part


def test_a_number_without_a_unit_and_an_array_without_a_shape_are_found():
    def silent(length: float, width: float) -> float:
        """An area [m^2].

        Args:
            length: of it [m].
            width: across it.
        """
        return length * width

    def shapeless(q: np.ndarray, v: np.ndarray) -> None:
        """A state.

        Args:
            q: of the joints, shape (nj,) [rad].
            v: of the joints [rad/s].
        """

    @dataclass
    class Shapeless:
        """Places.

        Attributes:
            one: shape (3,) [m].
            both: of the feet [m].
        """

        one: np.ndarray
        both: tuple[np.ndarray, np.ndarray]

    assert list(fields_without_shape(Shapeless)) == ["both"]
    assert list(silent_about(UNIT, NUMBER, silent, {})) == ["width"]
    assert list(silent_about(SHAPE, ARRAY, shapeless, {})) == ["v"]


ROOT = Path(__file__).parents[2]
FOLDERS = ("planner", "wbc", "sim", "models", "scenarios", "studies", "apps", "surefoot")
OTHERS = ("tests", "docs", "benchmarks", "examples")
OPENING = re.compile(r"\W*(What|Whether|Of|How|Where|When|Which|Who|Whose|Why|That|Those|By)\b")
"""First words of a docstring that begins with a clause, or with its object, in place of a noun or a verb."""
POINTER = re.compile(r"\blikewise\b|\bas of `", re.IGNORECASE)
"""Words that send a reader to another docstring for a meaning, a shape or a unit."""


def modules(folder):
    """Files of a folder, without those of the folders that surefoot/ holds as links."""
    for path in sorted((ROOT / folder).rglob("*.py")):
        if folder != "surefoot" or path.relative_to(ROOT / folder).parts[0] not in FOLDERS:
            yield path


def docstrings(text):
    """Docstrings of a source, also of constants, each with its line."""
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant) and isinstance(node.value.value, str):
            yield node.lineno, node.value.value


def unlike(text):
    """Lines with a docstring that begins with no noun or verb, or that points elsewhere."""
    return [line for line, said in docstrings(text) if OPENING.match(said) or POINTER.search(said)]


@pytest.mark.parametrize("folder", [*FOLDERS, *OTHERS])
def test_it_says_in_its_first_words_what_the_thing_is_or_does(folder):
    found = {path.relative_to(ROOT).as_posix(): unlike(path.read_text(encoding="utf-8")) for path in modules(folder)}
    assert len(found) >= 5
    assert {name: lines for name, lines in found.items() if lines} == {}


def test_a_docstring_that_begins_with_a_clause_or_points_elsewhere_is_found():
    said = (
        "Whether it walks.",
        "Of a leg [m].",
        "The gait.\n\nb: likewise.",
        "True if it walks.",
        "Length, where straight.",
    )
    assert unlike("\n".join(f'"""{one}"""' for one in said)) == [1, 2, 3]


def test_what_says_nothing_is_found():
    def silent(value):
        raise ValueError(value)

    assert raised(silent) == {"ValueError"}
    assert entries("X.\n\nArgs:\n    value: what [m],\n        shape (3,).\n") == {
        "value": "what [m],\n        shape (3,)."
    }
