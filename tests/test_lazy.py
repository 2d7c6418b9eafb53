"""Importing looks for no garbage, and a process that ends at once leaves nothing undone."""

import gc
import subprocess
import sys

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


PROGRAM = """
import atexit, sys, threading, time
from surefoot.lazy import ending_at_once
class Loud:
    def __del__(self):
        print("taken apart")
kept = Loud()
with ending_at_once():
    atexit.register(print, "asked for")
    threading.Thread(target=lambda: (time.sleep(0.1), print("thread"))).start()
    print("begun", end=" ")
    {}
"""


@pytest.mark.parametrize(
    ("last", "code", "told"),
    [
        pytest.param("sys.exit(3)", 3, "begun thread asked for", id="number"),
        pytest.param("sys.exit()", 0, "begun thread asked for", id="nothing"),
        pytest.param("sys.exit('why')", 1, "begun thread asked for taken apart", id="words"),
        pytest.param("1 / 0", 1, "begun thread asked for taken apart", id="defect"),
        pytest.param("pass", 0, "begun thread asked for taken apart", id="no exit"),
    ],
)
def test_a_process_that_ends_at_once_has_done_all_that_was_asked_for(last, code, told):
    done = subprocess.run([sys.executable, "-c", PROGRAM.format(last)], capture_output=True, text=True)
    assert (done.returncode, " ".join(done.stdout.split())) == (code, told)
