"""Needs of tests are found missing where none of them is there, and where half of one is."""

import re
import sys
from pathlib import Path

import needs
import pytest

from surefoot.sim import gl

pytestmark = pytest.mark.unit

TESTS = Path(__file__).parent


@pytest.fixture
def programs(tmp_path, monkeypatch):
    """Puts programs on an otherwise empty path, each with its exit code; they do nothing else."""

    def put(**codes):
        for name, code in codes.items():
            program = tmp_path / name
            program.write_text(f"#!{sys.executable}\nraise SystemExit({code})\n")
            program.chmod(0o755)
        monkeypatch.setenv("PATH", str(tmp_path))

    return put


def test_tests_are_skipped_for_want_of_a_need_alone():
    own = {"needs.py", "test_needs.py", "test_skips.py"}
    skips = re.compile(r"pytest\.(mark\.)?skip")
    assert [f.name for f in TESTS.rglob("*.py") if f.name not in own and skips.search(f.read_text("utf-8"))] == []


def test_no_need_has_the_words_of_another():
    beginnings = [need.beginning for need in needs.NEEDS]
    assert all(not a.startswith(b) for a in beginnings for b in beginnings if a is not b)
    assert all(beginning.startswith("needs ") for beginning in beginnings)


@pytest.mark.parametrize(
    ("there", "said"),
    [
        ({}, "no chromium and no chromedriver, "),
        ({"chromium": 0}, "no chromedriver, "),
        ({"chromedriver": 0}, "no chromium, "),
        ({"chromium": 0, "chromedriver": 1}, "chromedriver opens no page, "),
    ],
)
def test_a_browser_is_both_programs_and_a_page(programs, there, said):
    programs(**there)
    assert needs.BROWSER.lacks().startswith(said)


@pytest.mark.parametrize(("there", "said"), [({}, "no C compiler"), ({"cc": 1}, "'cc' compiles nothing")])
def test_a_compiler_is_one_that_compiles(programs, monkeypatch, there, said):
    monkeypatch.delenv("CC", raising=False)
    programs(**there)
    assert needs.COMPILER.lacks() == said


@pytest.mark.parametrize("library", ["libNoSuch.so.1", "libm.so.6"])
def test_a_library_that_gives_no_context_draws_nothing(monkeypatch, library):
    """None, and one that is there and cannot draw: its module refuses what the machine has."""
    monkeypatch.setattr(gl, "BACKENDS", {"egl": library})
    monkeypatch.setenv("PYOPENGL_PLATFORM", "glx")
    for name in [name for name in sys.modules if name.startswith("mujoco.egl")]:
        monkeypatch.delitem(sys.modules, name)
    assert needs.OPENGL.lacks().startswith("no off-screen OpenGL")


def test_packages_are_whole(monkeypatch, tmp_path):
    found = needs.importlib.util.find_spec
    monkeypatch.setattr(needs.importlib.util, "find_spec", lambda name: None if name == "furo" else found("json"))
    assert needs.SITE.lacks() == "no furo, pip install -e '.[docs]'"
    assert needs.MJLAB.lacks().startswith("no asset_zoo/robots/unitree_g1/xmls/g1.xml of it")
    monkeypatch.setattr(needs.sys, "executable", str(tmp_path / "python"))
    assert needs.RERUN.lacks() == "no program rerun, pip install 'surefoot[rerun]'"
    monkeypatch.setattr(needs.importlib.util, "find_spec", lambda name: None)
    assert [need.lacks()[:3] for need in (needs.SITE, needs.MJLAB, needs.RERUN)] == ["no "] * 3
    for axe in ("", str(tmp_path / "axe.min.js"), str(tmp_path)):
        monkeypatch.setenv("AXE", axe)
        assert needs.AXE.lacks().startswith("npm pack axe-core")
