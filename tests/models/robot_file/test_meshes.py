"""Meshes of links: the right place, size and side out, few triangles, and hulls that hold nearly all."""

import time

import numpy as np
import pytest
from scipy.spatial import ConvexHull

from surefoot.models import RobotError
from surefoot.models.robot_file.mesh_file import colour_in_file
from surefoot.models.robot_file.meshes import MOST_FACES, decimated, hull, merged

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
