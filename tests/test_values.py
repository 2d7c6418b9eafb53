"""Frozen dataclasses compiled late: they do what those of the standard library do, for every class of the package."""

import copy
import dataclasses
import inspect
import pickle
import subprocess
import sys

import pytest

from surefoot.values import dataclass, maker, opened

pytestmark = pytest.mark.unit


def both(slots=True, **options):
    """The same class made here and by the standard library."""

    def make(maker):
        @maker(frozen=True, slots=slots, **options)
        class Value:
            """A value."""

            a: int
            b: list = dataclasses.field(default_factory=list, compare=False)
            c: str = dataclasses.field(default="c", repr=False)
            d: float = dataclasses.field(init=False, default=2.5)
            e: int = dataclasses.field(default=3, kw_only=True, hash=False)

        return Value

    return make(dataclass), make(dataclasses.dataclass)


@pytest.fixture(params=[True, False], ids=["slots", "dict"])
def pair(request):
    """Both classes, with slots and without."""
    return both(request.param)


@dataclass(frozen=True, slots=True)
class Point:
    """Has what is derived of it."""

    x: float
    y: float = 2.0

    def __post_init__(self):
        object.__setattr__(self, "y", self.y * 2)


@dataclass(frozen=True, slots=True)
class Solid(Point):
    """A dataclass below another."""

    z: float = 0.0


class Named(Point):
    """A class below a dataclass that is none itself."""

    def __init__(self, name):
        super().__init__(1.0)
        self.name = name


GIVEN = [((1,), {}), ((1, [2]), {"e": 4}), ((), {"a": 5, "c": "x"}), ((7, [], "y"), {"e": 0})]
WRONG = [((), {}), ((1, 2, 3, 4), {}), ((1,), {"d": 1}), ((1,), {"z": 1})]


@pytest.mark.parametrize(("args", "named"), GIVEN)
def test_a_value_is_as_the_standard_librarys(pair, args, named):
    ours, theirs = (cls(*args, **named) for cls in pair)
    assert repr(ours) == repr(theirs)
    assert hash(ours) == hash(theirs)
    assert dataclasses.asdict(ours) == dataclasses.asdict(theirs)
    assert ours == type(ours)(*args, **named)
    assert (ours == theirs) is False
    assert (ours == dataclasses.replace(ours, a=9)) is (theirs == dataclasses.replace(theirs, a=9)) is False
    assert (ours == dataclasses.replace(ours, b=[9])) is (theirs == dataclasses.replace(theirs, b=[9])) is True


@pytest.mark.parametrize(("args", "named"), WRONG)
def test_so_is_what_a_constructor_refuses(pair, args, named):
    said = []
    for cls in pair:
        with pytest.raises(TypeError) as refusal:
            cls(*args, **named)
        said.append(str(refusal.value))
    assert said[0] == said[1]


def test_so_is_its_signature_before_and_after_one_was_made(pair):
    ours, theirs = pair
    wanted = inspect.signature(theirs)
    assert str(inspect.signature(ours)) == str(wanted)
    ours(1)
    assert str(inspect.signature(ours)) == str(wanted)
    assert ours.__match_args__ == theirs.__match_args__
    assert ours.__dataclass_params__.frozen is True


def test_it_cannot_be_changed(pair):
    for cls in pair:
        value = cls(1)
        with pytest.raises(dataclasses.FrozenInstanceError, match="cannot assign to field 'a'"):
            value.a = 2
        with pytest.raises(dataclasses.FrozenInstanceError, match="cannot delete field 'a'"):
            del value.a
    with pytest.raises(dataclasses.FrozenInstanceError):
        pair[0](1).other = 2


def test_each_has_its_own_list(pair):
    assert pair[0](1).b is not pair[0](1).b


def test_options_that_leave_methods_out():
    plain = both(eq=False, repr=False)
    one, other = plain[0](1), plain[0](1)
    assert one != other
    assert len({one, other}) == 2
    assert "object at" in repr(one)


def test_methods_of_its_own_stay():
    @dataclass(frozen=True, slots=True)
    class Own:
        a: int

        def __init__(self, text):
            object.__setattr__(self, "a", int(text))

        def __eq__(self, other):
            return True

        def __repr__(self):
            return "own"

    assert Own("3").a == 3
    assert repr(Own("3")) == "own"
    assert Own("3") == Own("4")
    assert hash(Own("3")) == hash((3,))
    assert list(inspect.signature(Own).parameters) == ["text"]


def test_what_is_below_a_dataclass():
    assert Solid(1.0, 2.0, 3.0) == Solid(1.0, z=3.0)
    assert repr(Solid(1.0)) == "Solid(x=1.0, y=4.0, z=0.0)"
    assert Solid(1.0) != Point(1.0)
    assert list(inspect.signature(Named).parameters) == ["name"]
    named = Named("n")
    named.name = "m"
    assert (named.x, named.y, named.name) == (1.0, 4.0, "m")
    with pytest.raises(dataclasses.FrozenInstanceError):
        named.x = 2.0

    @dataclasses.dataclass(frozen=True)
    class Theirs(Point):
        w: int = 1

    assert Theirs(1.0) == Theirs(1.0, 2.0, 1)


@pytest.mark.parametrize("value", [Point(3.0), Solid(1.0, z=2.0)])
@pytest.mark.parametrize("copied", [copy.copy, copy.deepcopy, lambda one: pickle.loads(pickle.dumps(one))])
def test_it_is_copied(value, copied):
    assert copied(value) == value
    assert copied(value).y == value.y


def test_one_that_holds_itself_can_be_shown():
    loop = both()[0](1)
    loop.b.append(loop)
    assert repr(loop).count("...") == 1


def test_a_mutable_one_is_the_standard_librarys():
    @dataclass(slots=True)
    class Mutable:
        a: int = 1

    value = Mutable()
    value.a = 2
    assert value == Mutable(2)
    assert Mutable.__hash__ is None


def test_nothing_is_compiled_at_import():
    code = """
import sys
import surefoot.scenarios.run.run
found = {
    thing for name, module in list(sys.modules.items()) if name.startswith("surefoot.")
    for thing in vars(module).values() if isinstance(thing, type) and thing.__module__.startswith("surefoot.")
}
frozen = [one for one in found if getattr(vars(one).get("__dataclass_params__"), "frozen", False)]
late = [one for one in frozen if one.__setattr__.__code__.co_filename.endswith("values.py")]
made = [one for one in late if one.__init__.__code__.co_name == "__init__"]
print(len(frozen), len(late), len(made))
"""
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    frozen, late, made = map(int, done.stdout.split())
    assert frozen == late > 100
    assert made < 0.25 * late


@dataclass(frozen=True, slots=True)
class Wide:
    """Has fields enough to be set while it is opened."""

    a: float
    b: float
    c: float
    d: float = 4.0

    def __post_init__(self):
        object.__setattr__(self, "d", self.d + self.a)


class Wider(Wide):
    """A class below, with a place for more."""


def test_a_value_of_many_fields_is_frozen_from_its_construction_on():
    value, below = Wide(1.0, 2.0, c=3.0), Wider(1.0, 2.0, 3.0)
    for one, kind in ((value, Wide), (below, Wider), (copy.copy(value), Wide), (dataclasses.replace(value), Wide)):
        assert type(one) is kind
        with pytest.raises(dataclasses.FrozenInstanceError):
            one.a = 2.0
    assert (below.a, below.b, below.c, below.d) == (value.a, value.b, value.c, value.d) == (1.0, 2.0, 3.0, 5.0)
    assert dataclasses.replace(value, d=0.0) == Wide(1.0, 2.0, 3.0, 0.0) != value


def test_what_is_made_opened_becomes_the_value():
    made = opened(Wide)()
    made.a, made.b, made.c, made.d = 1.0, 2.0, 3.0, 5.0
    made.__class__ = Wide
    assert made == Wide(1.0, 2.0, 3.0)
    with pytest.raises(dataclasses.FrozenInstanceError):
        made.a = 2.0


@pytest.mark.parametrize(("args", "named"), [((1.0, 2.0, 3.0), {}), ((1.0,), {"b": 2.0, "c": 3.0, "d": 0.0})])
def test_a_maker_makes_what_the_class_makes(args, named):
    make = maker(Wide)
    made, value = make(*args, **named), Wide(*args, **named)
    assert made == value
    assert type(made) is Wide
    with pytest.raises(dataclasses.FrozenInstanceError):
        made.a = 2.0
    with pytest.raises(TypeError):
        make(1.0)
    ours, _ = both()
    assert maker(ours)(1).b is not maker(ours)(1).b  # a default is made for each
