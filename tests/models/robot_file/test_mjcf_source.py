"""A robot of an MJCF as MuJoCo compiles it: defaults, welded bodies, joints beside origins, motors of all kinds."""

import biped
import mujoco
import needs
import numpy as np
import pinocchio as pin
import pytest
from mesh_files import stl, text_stl
from mjcf_biped import DRAWN, LIMITS, TEXT, described, leg, meshed
from test_meshes import ball

from surefoot.models import RobotError, RobotOptions, describe, explain
from surefoot.models.consistency import EnginePair
from surefoot.models.convert import pinocchio_to_mujoco, velocity_map
from surefoot.models.pinocchio import pinocchio_model
from surefoot.models.robot_file import compiled
from surefoot.models.robot_file.mesh_file import burden

pytestmark = pytest.mark.unit


def test_masses_and_forces_are_those_of_the_source(tmp_path) -> None:
    """Though a knee turns about a point beside its body's origin, from where the base of the source is the same."""
    robot, source = described(tmp_path), mujoco.MjModel.from_xml_string(TEXT)
    ours, data = pinocchio_model(robot), mujoco.MjData(source)
    rng = np.random.default_rng(0)
    for _ in range(50):
        q, v = EnginePair(robot).random_state(rng)
        pinocchio_to_mujoco(q, v, data.qpos, data.qvel)
        data.qvel[:] = 0.0
        mujoco.mj_forward(source, data)
        T, M = velocity_map(data.qpos, source.nv), np.zeros((source.nv, source.nv))
        mujoco.mj_fullM(source, data, M)
        np.testing.assert_allclose(T.T @ M @ T, pin.crba(ours, ours.createData(), q), atol=1e-9)
        np.testing.assert_allclose(
            T.T @ data.qfrc_bias, pin.computeGeneralizedGravity(ours, ours.createData(), q), atol=1e-9
        )
    assert EnginePair(robot).difference(q, v).largest < 1e-9


def test_torques_are_those_of_the_motors(tmp_path) -> None:
    robot = described(tmp_path)
    assert robot.torque_limit[:6] == pytest.approx((50, 60, 90, 160, 30, 40))
    assert robot.velocity_limit == pytest.approx(np.full(12, 12.0))


def test_a_knee_that_cannot_be_stretched_is_as_straight_as_it_gets(tmp_path) -> None:
    robot = described(tmp_path)
    assert robot.straight_joint_positions[robot.joint_names.index("left_knee")] == pytest.approx(0.2)


@pytest.mark.parametrize(
    ("change", "limits", "sentence"),
    [
        (("", ""), "velocity_limit: {'*': 12}\n", "'left_ankle_roll' and 1 more of biped have no torque limit"),
        (
            (
                "</worldbody>",
                f'<body name="other"><freejoint/><geom size="0.1"/>{leg("l", 1)}{leg("r", -1)}</body></worldbody>',
            ),
            LIMITS,
            "'base', 'other' in its world",
        ),
        (('type="plane"', 'type="plain"'), LIMITS, "biped.xml: .*mend it"),
        (('axis="0 0 1"/>', 'type="ball" limited="false"/>'), LIMITS, "'left_yaw' of biped is in a leg and cannot"),
    ],
)
def test_what_no_description_can_hold_is_refused(tmp_path, change, limits, sentence) -> None:
    with pytest.raises(RobotError, match=sentence):
        described(tmp_path, TEXT.replace(*change, 1) if change[0] else TEXT, limits)


@needs.MJLAB.mark
def test_g1_of_an_mjcf_is_g1_of_its_urdf(tmp_path) -> None:
    model = "package://mjlab/asset_zoo/robots/unitree_g1/xmls/g1.xml"
    path = tmp_path / "g1.yaml"
    path.write_text(
        f"name: g1\nmodel: {model}\nfeet: {{left: left_ankle_roll_link, right: right_ankle_roll_link}}\n"
        "torque_limit: {'*': 50}\nvelocity_limit: {'*': 20}\n"
    )
    one, other = describe(str(path), RobotOptions()), describe("g1", RobotOptions())
    assert (one.joint_names, one.roles) == (other.joint_names, other.roles)
    assert (one.mass, one.leg_length, one.com_height) == pytest.approx(
        (other.mass, other.leg_length, other.com_height), rel=1e-3
    )


def taken(monkeypatch):
    """Files that MuJoCo gets, by name, of each model that it compiles."""
    got, before = [], compiled.moderate
    monkeypatch.setattr(compiled, "moderate", lambda *args: got.append(before(*args)) or got[-1])
    return got


def test_meshes_that_are_not_dense_reach_mujoco_as_they_are(tmp_path, monkeypatch) -> None:
    got = taken(monkeypatch)
    explain(meshed(tmp_path, 20, DRAWN, 'mass="0"'))
    assert got == [dict.fromkeys(("mesh0.stl", "mesh1.stl"), (tmp_path / "m.stl").read_bytes())]


@pytest.mark.parametrize("kind", ["stl", "obj"])
def test_dense_meshes_become_coarser_but_for_those_that_say_how_heavy_a_body_is(tmp_path, monkeypatch, kind) -> None:
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    file = meshed(tmp_path, 60, DRAWN, 'mass="0"', weighs=("",), kind=kind)  # 14 400 each
    whole, got = describe(file, RobotOptions()), taken(monkeypatch)
    monkeypatch.setattr(compiled, "MOST_COMPILED", 20_000)
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "other"))
    told = explain(meshed(tmp_path, 60, DRAWN, 'mass="0"', weighs=("",), kind=kind))
    (files,) = got
    assert files[f"mesh2.{kind}"] == (tmp_path / f"m.{kind}").read_bytes()
    assert {name for name in files if name.startswith("thin")} == {"thin mesh0.stl", "thin mesh1.stl"}
    assert sum(burden(f".{name.rpartition('.')[2]}", data) for name, data in files.items()) <= 20_000
    assert any("made coarser, with at most 2800 triangles each: m." in note for note in told.notes)
    thin = told.description
    assert thin.mass == whole.mass
    for one, other in zip(pinocchio_model(thin).inertias, pinocchio_model(whole).inertias, strict=True):
        np.testing.assert_array_equal(one.toDynamicParameters(), other.toDynamicParameters())


@pytest.mark.parametrize(
    ("geom", "compiler"),
    [("", ""), (f'{DRAWN} type="box"', ""), ('density="1"', '<compiler inertiafromgeom="true"/>')],
)
def test_dense_meshes_by_which_bodies_have_inertia_or_size_are_refused(tmp_path, monkeypatch, geom, compiler) -> None:
    monkeypatch.setattr(compiled, "MOST_COMPILED", 20_000)
    explain(meshed(tmp_path, 60, DRAWN, DRAWN))
    with pytest.raises(RobotError, match=r"28800 triangles in MSH and in meshes by which .* at most 20000"):
        explain(meshed(tmp_path, 60, geom, geom, compiler=compiler))


def test_a_warning_of_mujoco_is_a_note_without_a_path_of_code(tmp_path, recwarn) -> None:
    text = TEXT.replace('<compiler angle="radian"/>', '<compiler angle="radian" settotalmass="20"/>')
    path = biped.write(tmp_path, text, biped.FILE.replace("biped.urdf", "biped.xml") + LIMITS, "biped.xml")
    found = explain(str(path))
    (told,) = [note for note in found.notes if note.startswith("MuJoCo remarks: ")]
    assert "settotalmass" in told
    assert ".py" not in told
    assert not recwarn.list
    assert found.description.mass == pytest.approx(20.0)


def test_a_model_whose_bodies_never_collide_is_remarked(tmp_path) -> None:
    """Its links touch by what is drawn; one that collides with the ground alone is none of these."""
    told = "no geom of the model collides (contype and conaffinity are 0), so links touch by what is drawn of them"
    notes = {}
    for way in ('contype="0" conaffinity="0"', 'contype="1" conaffinity="0"', ""):
        text = TEXT.replace('<geom density="500"/>', f'<geom density="500" {way}/>')
        path = biped.write(tmp_path, text, biped.FILE.replace("biped.urdf", "biped.xml") + LIMITS, "biped.xml")
        found = explain(str(path))
        notes[way] = told in found.notes
        assert 'name="left_thigh_shape"' in found.description.mjcf
    assert list(notes.values()) == [True, False, False]


def test_a_text_stl_is_read_as_a_binary_one(tmp_path) -> None:
    vertices, faces = ball(0.05, 8)
    text = TEXT.replace("<worldbody>", '<asset><mesh name="m" file="m.stl"/></asset><worldbody>', 1)
    text = text.replace("<freejoint/>", '<freejoint/><geom type="mesh" mesh="m"/>')
    seen = set()
    for write in (stl, text_stl):
        (tmp_path / "m.stl").write_bytes(write(vertices, faces))
        seen.add(described(tmp_path, text).mass)
    one, other = seen if len(seen) == 2 else (*seen, *seen)
    assert one == pytest.approx(other, rel=1e-6)
