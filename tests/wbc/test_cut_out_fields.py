"""Fields cut out of numbers when they are read."""

import pickle
from dataclasses import fields, replace

import numpy as np
import pytest

from surefoot.wbc.types import WbcReference

pytestmark = pytest.mark.unit


def reference():
    return WbcReference.of_numbers(np.arange(55.0), (True, True), 0.5, -1, 1, 0.25, -1)


def test_fields_that_are_cut_out_late_are_like_others():
    one, other = reference(), reference()
    named = [field.name for field in fields(one)]
    assert all(getattr(one, name) is getattr(one, name) for name in named)
    changed = replace(other, **{named[1]: getattr(one, named[1])})
    copied = pickle.loads(pickle.dumps(reference()))
    for name in named:
        if name not in ("numbers",):
            np.testing.assert_array_equal(getattr(changed, name), getattr(one, name))
            np.testing.assert_array_equal(getattr(copied, name), getattr(one, name))
    assert repr(one) == repr(reference())
    assert not hasattr(one, "no_such_field")
