"""Importing looks for no garbage."""

import gc

import pytest

from surefoot.lazy import importing

pytestmark = pytest.mark.unit


@pytest.fixture(autouse=True)
def thawed():
    """The other tests' objects are looked through again."""
    yield
    gc.unfreeze()


def test_no_garbage_is_looked_for_meanwhile():
    assert gc.isenabled()
    with importing():
        assert not gc.isenabled()
    assert gc.isenabled()
    assert gc.get_freeze_count() > 0


def test_a_fault_of_an_import_leaves_it_on():
    with pytest.raises(ImportError), importing():
        raise ImportError
    assert gc.isenabled()


def test_whoever_has_turned_it_off_finds_it_so():
    gc.disable()
    try:
        with importing():
            pass
        assert not gc.isenabled()
    finally:
        gc.enable()
