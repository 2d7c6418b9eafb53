"""Triangles: closed, turned outwards, of the right volume, parted at sharp edges."""

import numpy as np
import pytest

from surefoot.sim.triangles import box, capsule, creased, cylinder, ellipsoid

pytestmark = pytest.mark.unit

SOLIDS = {
    "box": (box(np.array([0.1, 0.2, 0.3])), 8 * 0.1 * 0.2 * 0.3, 1e-12),
    "ellipsoid": (ellipsoid(np.array([0.1, 0.2, 0.3])), 4 / 3 * np.pi * 0.006, 0.05),
    "cylinder": (cylinder(0.1, 0.3), np.pi * 0.01 * 0.6, 0.02),
    "capsule": (capsule(0.1, 0.3), np.pi * 0.01 * 0.6 + 4 / 3 * np.pi * 0.001, 0.05),
}


def volume(vertices: np.ndarray, faces: np.ndarray) -> float:
    """Volume inside triangles that are counter-clockwise from outside, by the divergence theorem."""
    a, b, c = np.moveaxis(vertices[faces], 1, 0)
    return float(np.sum(a * np.cross(b, c)) / 6)


@pytest.mark.parametrize("name", SOLIDS)
def test_volume(name: str) -> None:
    (vertices, faces), expected, tolerance = SOLIDS[name]
    assert volume(vertices, faces) == pytest.approx(expected, rel=tolerance)
    assert volume(vertices + np.array([1.0, 2.0, 3.0]), faces) == pytest.approx(volume(vertices, faces))


@pytest.mark.parametrize("name", SOLIDS)
def test_every_edge_has_two_sides(name: str) -> None:
    (vertices, faces), _, _ = SOLIDS[name]
    _, place = np.unique(vertices.round(9), axis=0, return_inverse=True)
    corners = place[faces]
    edges = np.concatenate([corners[:, [0, 1]], corners[:, [1, 2]], corners[:, [2, 0]]])
    assert {tuple(edge) for edge in edges} == {tuple(edge) for edge in edges[:, ::-1]}


def test_sharp_edges_part_the_sides_and_soft_ones_do_not() -> None:
    cube = np.array([[x, y, z] for x in (0.0, 1) for y in (0.0, 1) for z in (0.0, 1)])
    sides = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]]
    faces = np.array([[a, *pair] for a, b, c, d in sides for pair in ((b, c), (c, d))])
    vertices, parted = creased(cube, faces)
    assert len(vertices) == 6 * 4
    np.testing.assert_array_equal(vertices[parted], cube[faces])
    soft, faces = ellipsoid(np.ones(3))
    _, place = np.unique(soft.round(9), axis=0, return_inverse=True)
    welded = place[faces]
    assert len(creased(np.unique(soft.round(9), axis=0), welded)[0]) == len(np.unique(welded))
