"""The store in the user's cache folder: entries are found again as they were stored, and nothing else."""

import os
import subprocess
from pathlib import Path

import pytest

from surefoot.models import kept

pytestmark = pytest.mark.unit


@pytest.fixture(autouse=True)
def cache(tmp_path, monkeypatch):
    """A cache folder of its own."""
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    return tmp_path / "cache" / "surefoot" / "texts"


KEY = "a"


def found():
    """The text of the entry; None of one that is none."""
    try:
        return kept.opened(KEY, kept.read(kept.place("texts", KEY)))
    except OSError:
        return None


@pytest.fixture
def entry(cache):
    """The entry of a text that is kept."""
    kept.store("texts", KEY, b"text", most=16)
    assert found() == b"text"
    return cache / f"{KEY}.json"


@pytest.mark.parametrize("damage", [b"", b"\n", b"other\n{}", None], ids=["empty", "line", "seal", "cut"])
def test_a_damaged_entry_is_none(entry, damage):
    entry.write_bytes(entry.read_bytes()[:-2] if damage is None else damage)
    assert found() is None
    kept.store("texts", KEY, b"text", most=16)
    assert found() == b"text"


def test_an_entry_under_another_key_is_none(entry):
    assert kept.opened("b", entry.read_bytes()) is None


def test_without_a_folder_nothing_is_kept(tmp_path, monkeypatch):
    (tmp_path / "file").write_text("")
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "file"))
    kept.store("texts", KEY, b"text", most=16)
    assert found() is None


def test_the_oldest_entries_go(cache):
    for number in range(5):
        kept.store("texts", f"{number}", b"text", most=3)
    assert len(list(cache.glob("*"))) == 3
    assert kept.opened("4", kept.place("texts", "4").read_bytes()) == b"text"


@pytest.mark.parametrize("how", ["pipe", "folder", "device"])
def test_what_is_no_file_in_place_of_an_entry_is_not_waited_for(how, entry):
    entry.unlink()
    {"pipe": os.mkfifo, "folder": Path.mkdir, "device": lambda path: path.symlink_to("/dev/zero")}[how](entry)
    assert found() is None
    os.mkfifo(entry.with_suffix(f".{os.getpid()}"))
    kept.store("texts", KEY, b"text", most=16)
    assert found() == (None if how == "folder" else b"text")


def test_the_page_says_where_it_is_and_how_to_remove_it(monkeypatch, tmp_path):
    page = (Path(__file__).parents[2] / "docs" / "how-to" / "install.md").read_text(encoding="utf-8")
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
