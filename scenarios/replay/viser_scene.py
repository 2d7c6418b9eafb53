"""A replay as a scene of viser: every layer is a branch of the scene tree, where it is switched on and off."""

from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING, Any

import numpy as np

from scenarios.replay.content import Footprint, Replay
from scenarios.replay.viser_marks import closed, make_mark, rgb
from scenarios.replay.viser_stage import set_stage

if TYPE_CHECKING:
    import viser

SEE_THROUGH = 0.6
"""Opacity of the robot through which the marks inside it are seen."""

_QUADRANGLE = np.array([[0, 1, 2], [0, 2, 3]])


class ViserScene:
    """Nodes for everything in a replay; `show` moves them to a frame.

    Attributes:
        layers: nodes that hide all that is below them, by name.
    """

    def __init__(self, server: "viser.ViserServer", replay: Replay) -> None:
        self._scene = server.scene
        set_stage(server, replay)
        self.layers: dict[str, Any] = {}
        self._bodies = tuple(self._add_bodies(replay))
        for name in (*(track.layer for track in replay.tracks), "Taken footprints", "Paths"):
            self._add_layer(name)
        self._marks = tuple(make_mark(self._scene, track) for track in replay.tracks)
        self._footprints: list[Any] = []
        self.replace(replay)
        self.show(0)

    def replace(self, replay: Replay) -> None:
        """Show another stretch of the same run, in which it may have gone on."""
        self._replay = replay
        for index, footprint in enumerate(replay.footprints[len(self._footprints) :], start=len(self._footprints)):
            self._footprints.append(self._add_footprint(index, footprint))
        for track in replay.tracks:
            path = track.path(slice(None)) if track.trail else np.empty((0, 3))
            if len(path) > 1:
                lines = np.stack([path[:-1], path[1:]], axis=1)
                self._scene.add_line_segments(f"/Paths/{track.layer}", lines, rgb(track.color), thickness=0.004)

    def show(self, frame: int) -> None:
        """Move everything to a frame."""
        replay = self._replay
        for body, node in self._bodies:
            node.position, node.wxyz = replay.body_position[frame, body], replay.body_quaternion[frame, body]
        for mark, track in zip(self._marks, replay.tracks, strict=True):
            mark.show(track, frame)
        for node, footprint in zip(self._footprints, replay.footprints, strict=True):
            node.visible = footprint.since <= replay.time[frame] + 1e-9

    def _add_bodies(self, replay: Replay) -> Iterator[tuple[int, Any]]:
        """Terrain and robot; the robot twice, since forces and CoM are seen only through it."""
        yield from self._add_branch(replay, "Terrain", lambda body: body == 0)
        yield from self._add_branch(replay, "Robot", lambda body: body > 0, opacity=SEE_THROUGH)
        yield from self._add_branch(replay, "Robot, solid", lambda body: body > 0)
        self.layers["Robot, solid"].visible = False

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
            self._scene.add_mesh_simple(name, surface.vertices, surface.faces, color=color, **look)

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
