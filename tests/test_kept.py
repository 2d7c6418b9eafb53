"""What is kept in the user's cache folder: found again of the same sources, and never of others."""

import os
import subprocess
import sys
from pathlib import Path
from types import ModuleType

import pytest

from surefoot import kept

pytestmark = pytest.mark.unit


class Maker:
    """Makes a text, and counts how often."""

    def __init__(self):
        self.times = 0

    def __call__(self):
        self.times += 1
        return f"made {self.times} ✓"


@pytest.fixture(autouse=True)
def cache(tmp_path, monkeypatch):
    """A cache folder of its own."""
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    return tmp_path / "cache" / "surefoot" / "texts"


@pytest.fixture
def source(tmp_path, monkeypatch):
    """The file of a module of the package that is imported."""
    file = tmp_path / "probe.py"
    file.write_text("A = 1\n")
    module = ModuleType("surefoot.probe")
    module.__file__ = str(file)
    monkeypatch.setitem(sys.modules, module.__name__, module)
    return file


def test_a_text_of_the_same_sources_is_made_once(source):
    make = Maker()
    assert [kept.from_sources("a", make) for _ in range(3)] == ["made 1 ✓"] * 3
    assert make.times == 1


def test_another_text_is_another_entry(source):
    kept.from_sources("a", Maker())
    make = Maker()
    kept.from_sources("b", make)
    assert make.times == 1


def test_a_source_that_has_changed_makes_it_anew(source):
    make = Maker()
    kept.from_sources("a", make)
    source.write_text("A = 2\n")
    assert kept.from_sources("a", make) == "made 2 ✓"
    assert kept.from_sources("a", make) == "made 2 ✓"


def test_so_does_one_that_is_gone(source):
    make = Maker()
    kept.from_sources("a", make)
    source.unlink()
    assert kept.from_sources("a", make) == "made 2 ✓"


@pytest.mark.parametrize("damage", [b"", b"\n", b"other\n{}", None], ids=["empty", "line", "seal", "cut"])
def test_a_damaged_entry_is_made_anew(source, cache, damage):
    make = Maker()
    kept.from_sources("a", make)
    (entry,) = cache.glob("*.json")
    entry.write_bytes(entry.read_bytes()[:-2] if damage is None else damage)
    assert kept.from_sources("a", make) == "made 2 ✓"
    assert kept.from_sources("a", make) == "made 2 ✓"


def test_an_entry_under_another_key_is_none(source, cache):
    kept.from_sources("a", Maker())
    (entry,) = cache.glob("*.json")
    assert kept.opened(entry.stem, entry.read_bytes()) is not None
    other = ("1" if entry.stem[0] == "0" else "0") + entry.stem[1:]
    assert kept.opened(other, entry.read_bytes()) is None


def test_without_a_folder_nothing_is_kept(source, tmp_path, monkeypatch):
    (tmp_path / "file").write_text("")
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "file"))
    make = Maker()
    assert [kept.from_sources("a", make) for _ in range(2)] == ["made 1 ✓", "made 2 ✓"]


def test_the_oldest_entries_go(cache):
    for number in range(5):
        kept.store("texts", f"{number}", b"text", most=3)
    assert len(list(cache.glob("*"))) == 3
    assert kept.opened("4", kept.place("texts", "4").read_bytes()) == b"text"


@pytest.mark.parametrize("how", ["pipe", "folder", "device"])
def test_what_is_no_file_in_place_of_an_entry_is_not_waited_for(how, source, cache):
    make = Maker()
    kept.from_sources("a", make)
    (entry,) = cache.glob("*.json")
    entry.unlink()
    {"pipe": os.mkfifo, "folder": Path.mkdir, "device": lambda path: path.symlink_to("/dev/zero")}[how](entry)
    assert kept.from_sources("a", make) == "made 2 ✓"
    assert kept.from_sources("a", make) == ("made 3 ✓" if how == "folder" else "made 2 ✓")
    pipe = entry.with_suffix(f".{os.getpid()}")
    if not pipe.exists():
        os.mkfifo(pipe)
    kept.store("texts", "b", b"text", most=16)
    assert kept.opened("b", kept.read(kept.place("texts", "b"))) == b"text"


def test_the_page_says_where_it_is_and_how_to_remove_it(monkeypatch, tmp_path):
    page = (Path(__file__).parents[1] / "docs" / "how-to" / "install.md").read_text(encoding="utf-8")
    (line,) = [line for line in page.splitlines() if line.startswith("rm ")]
    for variable, base in (("XDG_CACHE_HOME", tmp_path / "cache"), ("HOME", tmp_path / "home" / ".cache")):
        monkeypatch.delenv("XDG_CACHE_HOME")
        monkeypatch.setenv(variable, str(base.parent if variable == "HOME" else base))
        kept.store("texts", "a", b"text", most=16)
        assert kept.place("texts", "a").is_file()
        assert kept.place("texts", "a").is_relative_to(base / "surefoot")
        subprocess.run(["sh", "-c", line], check=True)
        assert not (base / "surefoot").exists()
        monkeypatch.setenv("XDG_CACHE_HOME", "")
