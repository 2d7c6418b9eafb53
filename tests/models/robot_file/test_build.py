"""Robot files by path and name, in other sizes, with options; and a cache that is never stale."""

import subprocess
import sys

import biped
import mjcf_biped
import numpy as np
import pinocchio as pin
import pytest
from opened import opened_files

from surefoot.models import RobotError, RobotOptions, describe
from surefoot.models.belief import with_com_raised, with_mass_scaled
from surefoot.models.consistency import EnginePair
from surefoot.models.pinocchio import pinocchio_model
from surefoot.models.robot_file import build, cache
from surefoot.models.similar import scaled

pytestmark = pytest.mark.unit

HALF = "name: half\nmodel: humanoid100\nscale: 0.5\n"


@pytest.fixture
def derived(monkeypatch, tmp_path):
    """Gives the number of descriptions that were derived and kept, from an empty memory and an empty cache."""
    cache_home = tmp_path / "cache home"
    monkeypatch.setenv("XDG_CACHE_HOME", str(cache_home))
    build.unchanged.cache_clear()
    with opened_files() as opened:
        yield lambda: sum(writes and cache_home in path.parents and path.suffix != ".json" for path, writes in opened)


def same(one, other) -> bool:
    return all(np.array_equal(getattr(one, name), getattr(other, name)) for name in one.__slots__)


def test_a_known_robot_in_another_size(tmp_path) -> None:
    path = biped.write(tmp_path, None, HALF)
    found, known = describe(str(path), RobotOptions()), scaled(describe("humanoid100", RobotOptions()), 0.5)
    assert (found.name, found.mjcf, found.leg_length) == ("half", known.mjcf, 0.47)


def test_options_of_a_robot_in_another_size_are_in_its_own_metres_and_kilograms(tmp_path) -> None:
    path = biped.write(tmp_path, None, HALF)
    found = describe(str(path), RobotOptions(foot_length=0.1, foot_width=0.05, payload_mass=2.0))
    assert (found.sole_length, found.sole_width) == pytest.approx((0.1, 0.05))
    assert found.mass == pytest.approx(12.5 + 2.0)


def test_scale_is_the_similar_robot(tmp_path) -> None:
    one = describe(str(biped.write(tmp_path)), RobotOptions())
    two = describe(str(biped.write(tmp_path, None, biped.FILE + "scale: 2\n")), RobotOptions())
    assert same(two, scaled(one, 2.0))


def test_options_of_a_robot_file(tmp_path) -> None:
    path = str(biped.write(tmp_path))
    own = describe(path, RobotOptions())
    found = describe(path, RobotOptions(foot_length=0.1, payload_mass=3.0, payload_body="left_foot"))
    assert (found.sole_length, found.sole_width) == (0.1, own.sole_width)
    model = pinocchio_model(found)
    foot = model.frames[model.getFrameId("left_foot")].parentJoint
    assert found.mass == pytest.approx(own.mass + 3.0)
    assert model.inertias[foot].mass == pytest.approx(pinocchio_model(own).inertias[foot].mass + 3.0)
    import mujoco

    box = mujoco.MjModel.from_xml_string(found.mjcf).geom("left_sole_box")
    assert box.size[:2] == pytest.approx((0.05, own.sole_width / 2))


@pytest.mark.parametrize(
    ("options", "key"),
    [
        (RobotOptions(foot_length=1.0), "foot_length"),
        (RobotOptions(payload_mass=-1.0), "payload_mass"),
        (RobotOptions(payload_body="tosro"), "payload_body"),
    ],
)
def test_impossible_options_are_refused(tmp_path, options, key) -> None:
    with pytest.raises(RobotError) as refused:
        describe(str(biped.write(tmp_path)), options)
    assert refused.value.key == (key,)


def test_what_is_cached_is_what_was_derived(tmp_path, derived) -> None:
    path = str(biped.write(tmp_path, None, biped.FILE + "# cached\n"))
    one = describe(path, RobotOptions())
    build.unchanged.cache_clear()
    two = describe(path, RobotOptions())
    assert derived() == 1
    assert same(one, two)
    assert two.torque_limit.dtype == np.float64
    assert not two.torque_limit.flags.writeable


def test_no_other_content_is_ever_taken_for_it(tmp_path, derived) -> None:
    """The content is that of the file, the model or a mesh, even one of the same size and time."""
    mesh = '<link name="cap"><visual><geometry><mesh filename="cap.stl"/></geometry></visual></link>'
    fixed = '<joint name="cap_joint" type="fixed"><parent link="base"/><child link="cap"/></joint>'
    body = biped.Biped(extra=mesh + fixed)
    for x in (b"1", b"2"):
        corners = [b"0 0 0", b"0 %s 0" % x, b"%s 0 0" % x, b"0 0 1"]
        faces = b"".join(
            b"facet normal 0 0 0\nouter loop\n"
            + b"".join(b"vertex %s\n" % corners[k] for k in face)
            + b"endloop\nendfacet\n"
            for face in ((0, 1, 2), (0, 3, 1), (0, 2, 3), (1, 3, 2))
        )
        (tmp_path / "cap.stl").write_bytes(b"solid cap\n" + faces + b"endsolid cap\n")
        describe(str(biped.write(tmp_path, body)), RobotOptions())
        build.unchanged.cache_clear()
    assert derived() == 2
    describe(str(biped.write(tmp_path, body, biped.FILE + "com_height: 0.5\n")), RobotOptions())
    changed = body.urdf().replace('effort="80"', 'effort="81"')
    assert describe(str(biped.write(tmp_path, changed)), RobotOptions()).torque_limit[0] == 81.0
    assert derived() == 4


def test_a_cache_that_cannot_be_read_is_made_anew(tmp_path, derived) -> None:
    path = str(biped.write(tmp_path))
    one = describe(path, RobotOptions())
    (kept,) = (tmp_path / "cache home" / "surefoot" / "robots").glob("*.json")
    for text in ("", "[]", '{"description": {}}', kept.read_text().replace("mjcf", "mjfc")):
        kept.write_text(text)
        build.unchanged.cache_clear()
        assert same(describe(path, RobotOptions()), one)
    assert derived() == 5


def test_a_folder_that_cannot_be_written_keeps_nothing(tmp_path, monkeypatch) -> None:
    (tmp_path / "cache").write_text("no folder")
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    path = str(biped.write(tmp_path))
    assert describe(path, RobotOptions()).name == "biped"
    build.unchanged.cache_clear()
    assert describe(path, RobotOptions()).name == "biped"
    assert (tmp_path / "cache").read_text() == "no folder"


def test_a_file_of_many_references_is_read_once_for_the_key(tmp_path) -> None:
    """A mesh of 48 MB that two hundred elements named took 9 s."""
    file = tmp_path / "a"
    file.write_text("same")
    with opened_files() as opened:
        cache.digest([(f"{at}", file) for at in range(200)])
    assert [path for path, _ in opened].count(file) == 1


def test_the_code_is_part_of_the_key(tmp_path) -> None:
    file = tmp_path / "a"
    file.write_text("same")
    assert cache.digest([("model", file)], b"another importer") != cache.digest([("model", file)])


CHEST = (
    '<link name="chest"><inertial><origin xyz="0.1 0.2 0.3"/><mass value="3"/>'
    '<inertia ixx="0.02" iyy="0.02" izz="0.02" ixy="0" ixz="0" iyz="0"/></inertial></link>'
    '<joint name="waist" type="revolute"><parent link="base"/><child link="chest"/>'
    '<origin xyz="0 0 0.2" rpy="1.1 0.3 -0.5"/><axis xyz="0 0 1"/>'
    '<limit lower="-1" upper="1" effort="50" velocity="10"/></joint>'
)


@pytest.fixture
def slanted(tmp_path):
    """A robot whose trunk's frames do not stand upright."""
    path = biped.write(tmp_path, biped.Biped(extra=CHEST), biped.FILE + "torso: chest\n")
    return describe(str(path), RobotOptions())


def centre_of_mass(robot):
    model = pinocchio_model(robot)
    return pin.centerOfMass(model, model.createData(), pin.neutral(model)).copy()


def test_a_com_that_is_higher_than_believed_is_so_however_frames_are_turned(slanted) -> None:
    assert slanted.roles.waist == ("waist",)
    moved = centre_of_mass(with_com_raised(slanted, 0.1)) - centre_of_mass(slanted)
    np.testing.assert_allclose(moved, (0.0, 0.0, 0.1), atol=1e-12)


def test_masses_that_are_believed_wrongly_take_their_moments_with_them(slanted) -> None:
    one, other = (pinocchio_model(robot) for robot in (slanted, with_mass_scaled(slanted, 1.5)))
    for before, after in zip(one.inertias, other.inertias, strict=True):
        np.testing.assert_allclose(after.inertia, 1.5 * before.inertia, atol=1e-12)
    assert EnginePair(with_mass_scaled(slanted, 1.5)).pin_model.nv == one.nv


@pytest.mark.parametrize("suffix", ["urdf", "xml"])
def test_a_document_is_read_once_for_what_is_derived_of_it(tmp_path, derived, suffix):
    """Robot file and model alike: once more for the key of the cache, and for what is known already once a time."""
    limits = mjcf_biped.LIMITS if suffix == "xml" else ""
    file = biped.FILE.replace("biped.urdf", f"biped.{suffix}") + limits
    path = biped.write(tmp_path, mjcf_biped.TEXT if suffix == "xml" else None, file, f"biped.{suffix}")
    for times in (2, 1):
        with opened_files() as opened:
            describe(str(path), RobotOptions())
        seen = [file.name for file, _ in opened if tmp_path == file.parent]
        assert {name: seen.count(name) for name in seen} == {path.name: times, f"biped.{suffix}": times}
        assert derived() == 1


def test_nothing_that_reads_robot_files_knows_their_registry():
    code = "import sys; import surefoot.models.robot_file.derive, surefoot.models.robot_file.build; print(*sys.modules)"
    loaded = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout.split()
    assert "surefoot.models.robot_file.build" in loaded
    assert "surefoot.models.registry" not in loaded
