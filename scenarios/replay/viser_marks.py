"""Tracks as nodes of viser: spheres, arrows and outlines that follow them."""

from typing import TYPE_CHECKING, Any

import numpy as np

from scenarios.replay.content import Array, Color, Track

if TYPE_CHECKING:
    import viser


class Mark:
    """A node that follows a track; `layer/name` is its place in the scene tree."""

    def __init__(self, node: Any) -> None:
        self._node = node
        node.visible = False

    def show(self, track: Track, frame: int) -> None:
        """Move to a frame of its track, or out of sight."""
        shown = track.shown(frame)
        if shown:
            self._move(track.vertices[frame])
        self._node.visible = shown

    def _move(self, vertices: Array) -> None:
        raise NotImplementedError


class _Point(Mark):
    def _move(self, vertices: Array) -> None:
        self._node.position = vertices[0]


class _Arrow(Mark):
    def _move(self, vertices: Array) -> None:
        self._node.points = vertices[None]


class _Outline(Mark):
    def _move(self, vertices: Array) -> None:
        self._node.points = closed(vertices)


def make_mark(scene: "viser.SceneApi", track: Track) -> Mark:
    """Add the node of a track, not yet in sight."""
    name, color, size = f"/{track.layer}/{track.name}", rgb(track.color), track.size
    if track.kind == "point":
        return _Point(scene.add_icosphere(name, radius=size, color=color, subdivisions=2))
    if track.kind == "arrow":
        head: dict[str, Any] = {"head_radius": 2.2 * size, "head_length": 5.0 * size}
        return _Arrow(scene.add_arrows(name, np.zeros((1, 2, 3)), _linear(color), shaft_radius=size, **head))
    nowhere = np.zeros((track.vertices.shape[1], 2, 3))
    return _Outline(scene.add_line_segments(name, nowhere, color, thickness=2 * size))


def _linear(color: tuple[int, int, int]) -> tuple[int, int, int]:
    """The colour that viser, which takes those of arrows for linear light, shows as the given one."""
    red, green, blue = (round(255 * (channel / 255) ** 2.2) for channel in color)
    return red, green, blue


def closed(vertices: Array) -> Array:
    """Edges of a closed outline, shape (k, 2, 3)."""
    return np.stack([vertices, np.roll(vertices, -1, axis=0)], axis=1)


def rgb(color: Color) -> tuple[int, int, int]:
    """Colour in 256 steps per channel."""
    red, green, blue = (round(255 * channel) for channel in color)
    return red, green, blue
