"""The reference as a value: what users read of it, and how they change it."""

import copy
import pickle
from dataclasses import fields, replace

import numpy as np
import pytest

from surefoot.wbc.reference import WbcReference

pytestmark = pytest.mark.unit

SHAPES = {
    **{f"com{what}": (3,) for what in ("", "_velocity", "_acceleration")},
    **{f"swing_{what}": (3,) for what in ("position", "velocity", "acceleration")},
    **{f"swing_angular_{what}": (3,) for what in ("velocity", "acceleration")},
    "zmp": (2,),
    "zmp_offset": (2,),
    "swing_rotation": (3, 3),
    "ground_normal": (2, 3),
}


@pytest.fixture
def given(rng):
    """Arguments that differ from each other in each number."""
    arrays = {name: rng.normal(size=shape) for name, shape in SHAPES.items()}
    numbers = {"omega": 3.1, "stiffness": 9.7, "heading": 0.3, "heading_rate": -0.2, "swing_progress": 0.25}
    contacts = {"planned_contact": (True, False), "load_share": (0.75, 0.25), "time_to_switch": 0.5}
    feet = {
        "lifting_foot": -1,
        "swing_foot": 1,
        "edge": (-1, 1),
        "roll": ((0.4, 0.5, 0.6), (0.1, 0.2, 0.3)),
        "pelvis_yaw": (0.7, 0.8, 0.9),
        "pelvis_list": (0.15, 0.25, 0.35),
        "catching": True,
    }
    return {**arrays, **numbers, **contacts, **feet}


def assert_has(reference, given):
    for name in WbcReference.__match_args__:
        value = getattr(reference, name)
        np.testing.assert_array_equal(value, given[name])
        assert type(value) is type(given[name]), name


def test_it_has_what_it_was_given(given):
    assert len(given) == 27
    reference = WbcReference(**given)
    assert_has(reference, given)
    assert [field.name for field in fields(reference)] == [*WbcReference.__match_args__]
    assert not hasattr(reference, "no_such_field")
    assert repr(reference).startswith("WbcReference(com=array([")


@pytest.mark.parametrize("copied", [copy.copy, copy.deepcopy, lambda one: pickle.loads(pickle.dumps(one)), replace])
def test_a_copy_has_the_same(given, copied):
    assert_has(copied(WbcReference(**given)), given)


@pytest.mark.parametrize("name", WbcReference.__match_args__)
def test_one_that_is_changed_differs_in_that_alone(given, name):
    changed = {**given, name: {int: 0, bool: False}.get(type(given[name]), given[name])}
    if isinstance(given[name], np.ndarray):
        changed[name] = -given[name]
    elif isinstance(given[name], float):
        changed[name] = 2.0 * given[name]
    elif isinstance(given[name], tuple):
        changed[name] = given[name][::-1]
    reference = WbcReference(**given)
    assert_has(replace(reference, **{name: changed[name]}), changed)
    assert_has(reference, given)


def test_its_arrays_are_of_those_who_read_them(given):
    reference = WbcReference(**given)
    reference.com[:] = 0.0
    assert_has(reference, given)


@pytest.mark.parametrize("name", ["com", "zmp", "swing_rotation", "ground_normal"])
def test_an_array_of_another_shape_is_refused(given, name):
    with pytest.raises(ValueError):
        WbcReference(**{**given, name: np.zeros(4)})
