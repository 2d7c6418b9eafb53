"""The replay in viser: the stage, the robot on it, and the marks beside it."""

from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from surefoot.scenarios.palette import Color
from surefoot.scenarios.show.replay.content import Array, Footprint, Replay, Track

if TYPE_CHECKING:
    import viser


class MarkNode:
    """A node that follows a track; `layer/name` is its place in the scene tree, where it is not yet in sight."""

    def __init__(self, scene: "viser.SceneApi", track: Track) -> None:
        name, color, size = f"/{track.layer}/{track.name}", rgb(track.color), track.size
        self._kind, self._last = track.kind, np.empty(0)
        self._node: Any
        if track.kind == "point":
            self._node = scene.add_icosphere(name, radius=size, color=color, subdivisions=2)
        elif track.kind == "arrow":
            look: dict[str, Any] = {"shaft_radius": size, "head_radius": 2.2 * size, "head_length": 5.0 * size}
            self._node = scene.add_arrows(name, np.zeros((1, 2, 3)), _linear(color), **look)
        else:
            nowhere = np.zeros((track.vertices.shape[1], 2, 3))
            self._node = scene.add_line_segments(name, nowhere, color, thickness=2 * size)
        self._node.visible = False

    def show(self, track: Track, frame: int) -> None:
        """Move to a frame of its track, or out of sight."""
        shown, vertices = track.shown(frame), track.vertices[frame]
        if shown and not np.array_equal(vertices, self._last):
            if self._kind == "point":
                self._node.position = vertices[0]
            else:
                self._node.points = vertices[None] if self._kind == "arrow" else closed(vertices)
            self._last = vertices.copy()
        self._node.visible = shown


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


GROUND = "/Ground"
"""The node of the ground."""

STEP_BACK = np.array([1.7, -2.0, 0.35])
"""Step back of the camera at first from what it looks at [m]."""

LOOK_AT_HEIGHT = 0.75
"""Height over the ground of what the camera looks at [m]."""

GROUND_DEPTH = np.array([0.0, 0.0, -0.002])
"""Place of the ground, so that it does not fight with what lies on it [m]."""


def set_stage(server: "viser.ViserServer", replay: Replay) -> Any:
    """Set camera and light; gives the node of the ground."""
    scene, look_at = server.scene, replay.followed()[0].copy()
    scene.set_up_direction("+z")
    scene.world_axes.visible = False
    scene.configure_default_lights(cast_shadow=True)
    scene.set_background_image(_sky(), format="png")
    look_at[2] = replay.footprints[0].corners[0, 2] if replay.footprints else 0.0
    look_at[2] += LOOK_AT_HEIGHT
    server.initial_camera.look_at = look_at
    server.initial_camera.position = look_at + STEP_BACK
    server.initial_camera.fov = np.deg2rad(45.0)
    return scene.add_grid(
        GROUND, infinite_grid=True, cell_size=0.1, section_size=1.0, fade_distance=25.0,
        cell_color=(214, 218, 223), section_color=(165, 172, 180), plane_color=(238, 240, 242), plane_opacity=1.0,
        shadow_opacity=0.25, position=GROUND_DEPTH,
    )  # fmt: skip


SKY = ((0.0, (182, 206, 230)), (0.55, (226, 234, 241)), (1.0, (238, 240, 242)))
"""Colours of the sky from the top of the picture (0) to its bottom (1); the last is that of the ground [-]."""

SEE_THROUGH = "Robot, see-through"
"""Layer of the robot through which the marks inside it are seen, forces and CoM among them; hidden at first."""

_OPACITY = 0.6
"""Opacity of that layer [-]."""

_QUADRANGLE = np.array([[0, 1, 2], [0, 2, 3]])


def _sky() -> NDArray[np.uint8]:
    """Picture behind the scene, shape (64, 2, 3)."""
    at, colors = np.array([share for share, _ in SKY]), np.array([color for _, color in SKY], dtype=np.float64)
    height = np.linspace(0.0, 1.0, 64)
    column = np.stack([np.interp(height, at, channel) for channel in colors.T], axis=1)
    return np.repeat(column[:, None], 2, axis=1).round().astype(np.uint8)


class ViserScene:
    """Nodes for everything in a replay; `show` moves them to a frame.

    The robot is followed by moving the world below a camera that stays, since the camera belongs to the user, who turns
    and zooms it meanwhile.

    Attributes:
        layers: nodes that hide all that is below them, by name.
        skin: names of bodies, and the nodes of the robot's surfaces on them.
    """

    def __init__(self, server: "viser.ViserServer", replay: Replay) -> None:
        self._scene = server.scene
        self.skin: list[tuple[str, Any]] = []
        self._ground, self._origin = set_stage(server, replay), replay.followed()[0]
        self.layers: dict[str, Any] = {}
        self._bodies = tuple(self._add_bodies(replay))
        for name in (*(track.layer for track in replay.tracks), "Taken footprints", "Paths"):
            self._add_layer(name)
        self._marks = tuple(MarkNode(self._scene, track) for track in replay.tracks)
        self._footprints: list[Any] = []
        self.replace(replay)
        self.show(0)

    def replace(self, replay: Replay) -> None:
        """Show another stretch of the same run, in which it may have gone on."""
        self._replay, self._shift = replay, self._origin - replay.followed()
        for index, footprint in enumerate(replay.footprints[len(self._footprints) :], start=len(self._footprints)):
            self._footprints.append(self._add_footprint(index, footprint))
        for track in replay.tracks:
            path = track.path(slice(None)) if track.trail else np.empty((0, 3))
            if len(path) > 1:
                lines = np.stack([path[:-1], path[1:]], axis=1)
                self._scene.add_line_segments(f"/Paths/{track.layer}", lines, rgb(track.color), thickness=0.004)

    @property
    def moving_layers(self) -> tuple[str, ...]:
        """Names of the nodes that move when the robot is followed."""
        return (GROUND, *(f"/{name}" for name in self.layers))

    def show(self, frame: int, follow: bool = True) -> None:
        """Move everything to a frame; without following, the world stays where it is."""
        replay = self._replay
        if follow:
            shift = self._shift[frame]
            self._ground.position = GROUND_DEPTH + shift
            for layer in self.layers.values():
                layer.position = shift
        for body, node in self._bodies:
            node.position, node.wxyz = replay.body_position[frame, body], replay.body_quaternion[frame, body]
        for mark, track in zip(self._marks, replay.tracks, strict=True):
            mark.show(track, frame)
        for node, footprint in zip(self._footprints, replay.footprints, strict=True):
            node.visible = footprint.since <= replay.time[frame] + 1e-9

    def _add_bodies(self, replay: Replay) -> Iterator[tuple[int, Any]]:
        """Terrain and robot, which is there twice: solid, and to see through."""
        yield from self._add_branch(replay, "Terrain", lambda body: body == 0)
        yield from self._add_branch(replay, "Robot", lambda body: body > 0)
        yield from self._add_branch(replay, SEE_THROUGH, lambda body: body > 0, opacity=_OPACITY)
        if SEE_THROUGH in self.layers:
            self.layers[SEE_THROUGH].visible = False

    def _add_branch(
        self, replay: Replay, layer: str, wanted: Callable[[int], bool], **look: Any
    ) -> Iterator[tuple[int, Any]]:
        """A node per body that has surfaces, and its surfaces below it."""
        chosen = [surface for surface in replay.surfaces if wanted(surface.body)]
        if chosen:
            self._add_layer(layer)
        for body in dict.fromkeys(surface.body for surface in chosen):
            yield body, self._scene.add_frame(f"/{layer}/{replay.body_names[body]}", show_axes=False)
        for index, surface in enumerate(chosen):
            name, color = f"/{layer}/{replay.body_names[surface.body]}/{index}", rgb(surface.color)
            node = self._scene.add_mesh_simple(name, surface.vertices, surface.faces, color=color, **look)
            if surface.body > 0:
                self.skin.append((replay.body_names[surface.body], node))

    def _add_layer(self, name: str) -> None:
        if name not in self.layers:
            self.layers[name] = self._scene.add_frame(f"/{name}", show_axes=False)

    def _add_footprint(self, index: int, footprint: Footprint) -> Any:
        name, color = f"/Taken footprints/{index}", rgb(footprint.color)
        node = self._scene.add_frame(name, show_axes=False, visible=False)
        self._scene.add_line_segments(f"{name}/outline", closed(footprint.corners), color, thickness=0.006)
        area: dict[str, Any] = {"color": color, "opacity": 0.3, "cast_shadow": False, "side": "double"}
        self._scene.add_mesh_simple(f"{name}/area", footprint.corners, _QUADRANGLE, **area)
        return node
