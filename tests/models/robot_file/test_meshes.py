"""Meshes of links: the right place, size and side out, few triangles, and hulls that hold nearly all."""

import time

import biped
import numpy as np
import pytest
from scipy.spatial import ConvexHull

from surefoot.models import RobotError, explain
from surefoot.models.robot_file import shapes
from surefoot.models.robot_file.mesh_file import MOST_WORDS, colour_in_file, read_mesh
from surefoot.models.robot_file.meshes import MOST_EXACT, MOST_FACES, decimated, hull, merged, outer, thinned

pytestmark = pytest.mark.unit


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


@pytest.mark.parametrize("size", [1.0, 1e-3])
def test_few_triangles_keep_place_size_and_side(size) -> None:
    vertices, faces = ball(size)
    corners = vertices[faces].reshape(-1, 3) + np.array([0.0, 0.0, size])
    soup = (corners, np.arange(faces.size).reshape(-1, 3))
    ((points, kept),) = decimated([soup], 400)
    assert 200 < len(kept) <= 420
    low, high = points.min(axis=0), points.max(axis=0)
    np.testing.assert_allclose(0.5 * (low + high), [0.0, 0.0, size], atol=0.02 * size)
    np.testing.assert_allclose(high - low, 2.0 * size, rtol=0.05)
    assert volume(points, kept) == pytest.approx(4 / 3 * np.pi * size**3, rel=0.05)


def test_triangles_are_shared_by_size_and_none_gets_more_than_it_has() -> None:
    parts = [ball(1.0), ball(0.1), ball(1.0, 4), ball(1e-4)]
    large, small, plain, speck = (len(faces) for _, faces in decimated(parts, 2000))
    assert plain <= len(parts[2][1])
    assert large > 3 * small > 100
    assert large + small + plain <= 2050
    assert speck == 0


def test_nothing_is_left_alone() -> None:
    flat = (np.zeros((3, 3)), np.array([[0, 1, 2]]))
    assert decimated([]) == ()
    assert decimated([flat]) == (flat,)
    empty = (np.zeros((0, 3)), np.zeros((0, 3), dtype=np.int64))
    assert len(decimated([empty, ball(1.0)])[0][1]) == 0


def test_the_colour_of_a_mesh_file(tmp_path) -> None:
    (tmp_path / "m.mtl").write_text("newmtl grey\nNs 3\nKd 0.32 0.3 1.1\n")
    assert colour_in_file(tmp_path / "m.obj") == (0.32, 0.3, 1.0)
    (tmp_path / "m.dae").write_text('<phong><diffuse>\n<color sid="diffuse">0.1 0.2 0.3 1</color></diffuse></phong>')
    assert colour_in_file(tmp_path / "m.dae") == (0.1, 0.2, 0.3)
    assert colour_in_file(tmp_path / "other.obj") is colour_in_file(tmp_path / "m.stl") is None


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


def test_many_triangles_between_few_places_take_seconds() -> None:
    """Each vertex had a hundred thousand triangles, of which collapsing came to no end."""
    corners = np.random.default_rng(0).uniform(-0.1, 0.1, (2_100_000, 3))
    begin = time.process_time()
    (part,) = decimated([(corners, np.arange(len(corners)).reshape(-1, 3))])
    assert time.process_time() - begin < 10.0
    assert 0 < len(part[1]) <= MOST_FACES


def rough_ball(triangles):
    """A sphere of a decimetre with a millimetre of noise, of which collapsing its edges takes long."""
    vertices, faces = ball(0.1, round((triangles / 4) ** 0.5))
    return vertices + np.random.default_rng(0).normal(scale=1e-3, size=vertices.shape), faces


@pytest.mark.parametrize("triangles", [300_000, pytest.param(2_400_000, marks=pytest.mark.long)])
def test_rough_meshes_get_as_few_triangles_as_there_may_be_within_seconds(triangles) -> None:
    """A third of a million were left of 1.2 million, after half a minute."""
    part = rough_ball(triangles)
    begin = time.process_time()
    ((points, kept),) = decimated([part])
    assert time.process_time() - begin < 10.0
    assert 1000 < len(kept) <= 1.2 * MOST_FACES
    np.testing.assert_allclose(np.ptp(points, axis=0), 0.2, atol=0.015)


def reach(points, directions):
    """Reach of points in each direction, some at a time, since all together fill the memory."""
    return np.concatenate([(points @ some.T).max(axis=0) for some in np.array_split(directions, 50)])


def test_a_thinned_mesh_keeps_some_vertices_and_nearly_its_hull() -> None:
    directions = np.random.default_rng(1).normal(size=(300, 3))
    directions /= np.linalg.norm(directions, axis=1)[:, None]
    flat = ball(0.1, 160)
    for vertices, faces in (ball(0.1, 160), rough_ball(100_000), (flat[0] * [1.0, 0.5, 0.05], flat[1])):
        points, kept = thinned((vertices, faces), 20_000)
        assert 4000 < len(kept) <= 20_000
        assert {tuple(point) for point in points} <= {tuple(vertex) for vertex in vertices}
        assert (reach(vertices, directions) - reach(points, directions)).max() < 2e-3 * np.ptp(vertices)
        assert volume(points, kept) == pytest.approx(volume(vertices, faces), rel=0.05)
    assert len(thinned((vertices, faces), 10**6)[1]) > 0.9 * len(faces)


def test_the_hull_of_very_many_points_is_true_to_a_thousandth() -> None:
    flat = ball(1.0, 300)[0] * [0.1, 0.05, 0.002]
    directions = np.random.default_rng(1).normal(size=(2000, 3))
    directions /= np.linalg.norm(directions, axis=1)[:, None]
    for points in (flat, rough_ball(400_000)[0]):
        assert len(points) > MOST_EXACT
        kept = outer(points)
        assert len(kept) < 0.1 * len(points)
        lacking = reach(points, directions) - reach(kept, directions)
        assert lacking.min() >= 0.0
        assert lacking.max() < 1e-3 * np.ptp(points, axis=0).max()
    few = flat[:MOST_EXACT]
    assert outer(few) is few


def sparse(path, size):
    with path.open("wb") as file:
        file.truncate(size)


def test_text_that_is_long_or_has_many_words_is_refused(tmp_path) -> None:
    sparse(tmp_path / "long.obj", (32 << 20) + 1)
    with pytest.raises(RobotError, match=r"long.obj: has 33554433 bytes, more than 33554432; .*binary STL"):
        read_mesh(tmp_path / "long.obj")
    (tmp_path / "dense.obj").write_bytes(b"f 1 1 1\n" * (MOST_WORDS // 4 + 1))
    with pytest.raises(RobotError, match=r"dense.obj: cannot be read, it has 8000004 spaces"):
        read_mesh(tmp_path / "dense.obj")


def test_bytes_of_all_text_and_triangles_of_all_shapes_are_bounded(tmp_path, monkeypatch) -> None:
    names = [f"m{at}.dae" for at in range(3)]
    for name in names:
        sparse(tmp_path / name, 20 << 20)
    mesh = "".join(f'<visual><geometry><mesh filename="{name}"/></geometry></visual>' for name in names)
    model = biped.Biped().urdf().replace("</link>", f"{mesh}</link>", 1)
    with pytest.raises(RobotError, match=r"its OBJ and DAE have 62914560 bytes together; .*binary STL"):
        explain(str(biped.write(tmp_path, model)))
    monkeypatch.setattr(shapes, "MOST_TRIANGLES", 200)  # 132 are drawn, as many touch
    with pytest.raises(RobotError, match="more than 200 triangles; give coarser ones"):
        explain(str(biped.write(tmp_path)))
