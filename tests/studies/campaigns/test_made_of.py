"""The digest of a result: whatever changes a robot changes it, and nothing else does."""

import importlib
import os
from pathlib import Path

import pytest

from surefoot.scenarios.many.journal import MadeOf
from surefoot.scenarios.many.points import Base, Point
from surefoot.scenarios.record.provenance import relevant_versions
from surefoot.scenarios.setup.load import written

pytestmark = pytest.mark.unit

CAP = """
<link name="cap"><visual><geometry><mesh filename="cap.stl"/></geometry></visual></link>
<joint name="cap_joint" type="fixed"><parent link="base"/><child link="cap"/></joint>
"""
ROTOR = '<robot name="biped"><rotor_params><joint name="left_knee" mass="0.001" gear_ratio="9"/></rotor_params></robot>'


def cap(height):
    """A tetrahedron of this height as STL."""
    corners = ("0 0 0", "0 1 0", "1 0 0", f"0 0 {height}")
    faces = ("\n".join(f"vertex {corners[k]}" for k in face) for face in ((0, 1, 2), (0, 3, 1), (0, 2, 3), (1, 3, 2)))
    facets = (f"facet normal 0 0 0\nouter loop\n{face}\nendloop\nendfacet\n" for face in faces)
    return f"solid cap\n{''.join(facets)}endsolid cap\n"


@pytest.fixture
def biped(tmp_path, monkeypatch):
    """A robot of one's own: robot file, URDF, mesh and SRDF, and a scenario beside them that names it."""
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    monkeypatch.syspath_prepend(str(Path(__file__).parents[2] / "models" / "robot_file"))
    module = importlib.import_module("biped")
    (tmp_path / "cap.stl").write_text(cap(1))
    (tmp_path / "biped.srdf").write_text(ROTOR)
    module.write(tmp_path, module.Biped(extra=CAP), module.FILE + "srdf: biped.srdf\n")
    (tmp_path / "mine.yaml").write_text("robot: biped.yaml\nfidelity: pendulum\n")
    return tmp_path


def digest(made_of=None, scenario="paper-walk", anywhere=False, **settings):
    base = Base(scenario, written(scenario))
    return (made_of or MadeOf()).of(Point(base, settings, {}, "run"), anywhere)


@pytest.mark.parametrize("named", ["in the file", "in a setting"])
@pytest.mark.parametrize(
    ("name", "old", "new"),
    [
        ("biped.yaml", "srdf:", "com_height: 0.55\nsrdf:"),
        ("biped.urdf", 'effort="80"', 'effort="81"'),
        ("cap.stl", "0 0 1", "0 0 2"),
        ("biped.srdf", "0.001", "0.002"),
    ],
)
def test_every_file_of_the_robot_is_in_it(biped, monkeypatch, name, old, new, named):
    def now():
        monkeypatch.chdir("/" if named == "in the file" else biped)
        own = {} if named == "in the file" else {"robot": "biped.yaml"}
        return digest(scenario=str(biped / "mine.yaml") if not own else "paper-walk", **own)

    file = biped / name
    text, before = file.read_text(), now()
    assert old in text and before == now()
    file.write_text(text.replace(old, new))
    assert now() != before, "also where size and name of the file are what they were"
    file.write_text(text)
    os.utime(file, ns=(1, 1))
    assert now() == before, "files that are as they were make the same robot, whatever their times"
    file.unlink()
    assert now() != before


def test_a_robot_that_is_mended_is_another_one(biped):
    file, scenario = biped / "biped.urdf", str(biped / "mine.yaml")
    whole = file.read_text()
    file.write_text(whole.replace('effort="80"', 'effort="-1"'))
    broken = digest(scenario=scenario)
    file.write_text(whole)
    assert digest(scenario=scenario) != broken


def test_robots_that_do_not_walk_do_not_matter(biped):
    before = digest()
    (biped / "biped.urdf").unlink()
    assert digest() == before
    assert digest(robot="g1") != before


def test_machines_of_a_cluster_may_differ_in_what_is_of_a_machine():
    there = MadeOf(lambda: {**relevant_versions(), "machine": "Linux riscv64", "python": "3.99"})
    assert digest(there) != digest()
    assert digest(there, anywhere=True) == digest(anywhere=True)


def test_results_of_modules_that_were_compiled_otherwise_are_others():
    there = MadeOf(lambda: {**relevant_versions(), "native": "Cython 3.3, gcc 1.0 -Ofast"})
    assert digest(there) != digest()
    assert digest(there, anywhere=True) != digest(anywhere=True)
