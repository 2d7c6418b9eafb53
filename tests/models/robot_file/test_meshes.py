"""Meshes of links: the right place, size and side out, few triangles, and hulls that hold nearly all."""

import numpy as np
import pinocchio as pin
import pytest
from scipy.spatial import ConvexHull

from surefoot.models import RobotError
from surefoot.models.robot_file.meshes import hull, links_meshes, loader, merged, triangles

pytestmark = pytest.mark.unit

URDF = """<robot name="r">
  <material name="red"><color rgba="0.8 0.1 0.2 1"/></material>
  <link name="base"><inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>
    <visual><geometry><box size="1 1 1"/></geometry></visual></link>
  <joint name="knee" type="revolute"><parent link="base"/><child link="shank"/><axis xyz="0 1 0"/>
    <limit lower="-1" upper="1" effort="1" velocity="1"/></joint>
  <link name="shank"><inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>
    <visual><origin xyz="0 0 -0.5" rpy="0 0 1.5707963267948966"/>
      <geometry><mesh filename="{path}" scale="{scale}"/></geometry><material name="red"/></visual></link>
</robot>"""


def ball(radius, rings=60):
    """A fine sphere: vertices and faces."""
    around, up = np.meshgrid(np.arange(2 * rings), np.arange(rings + 1))
    phi, theta = np.pi * around / rings, np.pi * up / rings
    grid = np.stack([np.sin(theta) * np.cos(phi), np.sin(theta) * np.sin(phi), -np.cos(theta)], axis=2)
    here = (around + up * 2 * rings)[:-1].ravel()
    beside = np.roll((around + up * 2 * rings)[:-1], -1, axis=1).ravel()
    faces = np.concatenate(
        [np.stack([here, beside, beside + 2 * rings], 1), np.stack([here, beside + 2 * rings, here + 2 * rings], 1)]
    )
    return radius * grid.reshape(-1, 3), faces


def volume(vertices, faces):
    return np.einsum("ij,ij->", vertices[faces[:, 0]], np.cross(vertices[faces[:, 1]], vertices[faces[:, 2]])) / 6.0


def write_stl(path, vertices, faces):
    kind = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])
    soup = np.zeros(len(faces), kind)
    soup["corners"] = vertices[faces]
    path.write_bytes(b"solid, or so it says".ljust(80) + np.uint32(len(faces)).tobytes() + soup.tobytes())


def write_obj(path, vertices, faces):
    lines = [f"v {x} {y} {z}" for x, y, z in vertices] + [f"f {a} {b} {c}" for a, b, c in faces + 1]
    path.write_text("mtllib mesh.mtl\nusemtl grey\n" + "\n".join(lines))
    path.with_suffix(".mtl").write_text("newmtl grey\nKd 0.32 0.3 0.1\n")


def described(path, scale="1 1 1", urdf=URDF):
    text = urdf.format(path=path, scale=scale)
    model = pin.buildModelFromXML(text)
    return pin.buildGeomFromUrdfString(model, text, pin.VISUAL, mesh_loader=loader())


@pytest.mark.parametrize("write, name", [(write_stl, "m.stl"), (write_obj, "m.obj")])
@pytest.mark.parametrize("scale, size", [("1 1 1", (1, 1, 1)), ("0.001 -0.002 0.001", (0.002, 0.001, 0.001))])
def test_a_mesh_is_small_and_where_it_was(tmp_path, write, name, scale, size) -> None:
    write(tmp_path / name, *ball(0.1))
    (link,) = links_meshes(described(tmp_path / name, scale), most_faces=400)
    assert (link.name, link.joint, link.rgba) == ("shank_0", 1, (0.8, 0.1, 0.2, 1.0))
    assert 200 < len(link.faces) <= 420
    low, high = link.vertices.min(axis=0), link.vertices.max(axis=0)
    np.testing.assert_allclose(0.5 * (low + high), [0.0, 0.0, -0.5], atol=0.02 * 0.1 * max(size))
    np.testing.assert_allclose(high - low, 0.2 * np.array(size), rtol=0.05)
    assert volume(link.vertices, link.faces) == pytest.approx(4 / 3 * np.pi * 1e-3 * np.prod(size), rel=0.05)


def test_the_colour_of_the_file_holds_where_the_description_has_none(tmp_path) -> None:
    write_obj(tmp_path / "m.obj", *ball(0.1, 6))
    plain = URDF.replace('<material name="red"/>', "")
    (link,) = links_meshes(described(tmp_path / "m.obj", urdf=plain), most_faces=400)
    assert link.rgba == (0.32, 0.3, 0.1, 1.0)


def test_triangles_are_shared_by_size_and_none_gets_more_than_it_has() -> None:
    geometry = pin.GeometryModel()
    given = {"large": ball(1.0), "small": ball(0.1), "plain": ball(1.0, 4)}
    for name in given:
        geometry.addGeometryObject(pin.GeometryObject(name, 0, pin.SE3.Identity(), pin.hppfcl.Sphere(1.0)))
    large, small, plain = links_meshes(geometry, 2000, given)
    assert len(plain.faces) <= len(given["plain"][1])
    assert len(large.faces) > 3 * len(small.faces) > 100
    assert len(large.faces) + len(small.faces) + len(plain.faces) <= 2050


def test_a_file_that_is_no_mesh_is_named(tmp_path) -> None:
    write_stl(tmp_path / "m.stl", *ball(0.1, 4))
    geometry = described(tmp_path / "m.stl")
    (tmp_path / "m.stl").write_text("solid nothing\nendsolid")
    with pytest.raises(RobotError, match=r"m\.stl cannot be read"):
        triangles(geometry.geometryObjects[1])
    (tmp_path / "m.stl").unlink()
    with pytest.raises(RobotError, match="No such file"):
        links_meshes(geometry, 100)


def test_merged_closes_seams_and_drops_what_is_in_one_cell() -> None:
    vertices, faces = ball(1.0, 8)
    speck = np.array([[3.0, 0.0, 0.0], [3.0, 1e-3, 0.0], [3.0, 0.0, 1e-3]])
    soup = np.concatenate((vertices[faces].reshape(-1, 3), speck))
    points, kept = merged((soup, np.arange(len(soup)).reshape(-1, 3)), 0.01)
    assert len(points) == 16 * 7 + 2
    edges = np.sort(kept[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1)
    assert (np.unique(edges, axis=0, return_counts=True)[1] == 2).all()  # closed
    assert volume(points, kept) == pytest.approx(volume(vertices, faces), rel=0.01)


def test_a_hull_is_closed_faces_out_and_holds_nearly_all(tmp_path) -> None:
    rng = np.random.default_rng(4)
    cloud = np.concatenate((rng.normal(size=(4000, 3)) * [0.05, 0.05, 0.1], [[0.9, 0.0, 0.0]]))
    whole = ConvexHull(cloud)
    exact, _ = hull(cloud, len(whole.vertices))
    assert {tuple(corner) for corner in exact} == {tuple(corner) for corner in cloud[whole.vertices]}
    vertices, faces = hull(ball(0.1)[0] * [1, 2, 3], 60)
    assert len(vertices) == 60
    assert len(faces) == 2 * 60 - 4  # Euler, of a closed surface of triangles
    assert volume(vertices, faces) == pytest.approx(4 / 3 * np.pi * 6e-3, rel=0.15)
    assert volume(vertices, faces) == pytest.approx(ConvexHull(vertices).volume, rel=1e-9)
    spiked, _ = hull(cloud, 30)
    assert spiked.max() == 0.9


def test_a_flat_mesh_has_no_hull() -> None:
    with pytest.raises(RobotError, match="no volume"):
        hull(np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0], [0.5, 0.2, 0]]), 10)
