"""A recording for rerun: robot, points, forces and footprints of a replay, its curves, and how they are laid out."""

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

from surefoot.scenarios.errors import require
from surefoot.scenarios.log import Log, read
from surefoot.scenarios.output import refuse_existing, write_whole
from surefoot.scenarios.show.replay.content import Array, Replay, ReplayWindow, Track
from surefoot.scenarios.show.replay.extract import extract
from surefoot.scenarios.show.replay.page import CHARTS, beside_replay
from surefoot.scenarios.show.replay.scene import closed, rgb

TIMELINE = "time"
"""Simulated time [s]."""


def write_rrd(log: Path, out: Path, window: ReplayWindow | None = None, replace: bool = False) -> None:
    """Write the recording of a log.

    Raises:
        MissingExtraError: rerun is not installed.
        LogError: the log cannot be read; the file exists, and shall not be replaced, or cannot be written.
    """
    refuse_existing(out, replace)
    rerun = require("rerun", "rerun", "an rrd file", "open the log itself in a viewer, see docs/viewers.md")
    opened = read(log)
    replay = extract(opened, window)
    with write_whole(out, replace) as temporary:
        recording = rerun.RecordingStream("surefoot", recording_id=replay.title, send_properties=False)
        recording.save(temporary, default_blueprint=layout(require("rerun.blueprint", "rerun", "an rrd file")))
        Recorder(rerun, recording, replay).write(opened)
        recording.flush()
        recording.disconnect()


def layout(blueprint: Any) -> Any:
    """The robot at the left, and beside it a plot for each chart of a replay."""
    plots = [blueprint.TimeSeriesView(origin=f"/charts/{index}", name=c.label) for index, c in enumerate(CHARTS)]
    scene = blueprint.Spatial3DView(origin="/scene", name="robot")
    beside = blueprint.Horizontal(scene, blueprint.Vertical(*plots), column_shares=[3, 2])
    return blueprint.Blueprint(beside, collapse_panels=True)


class Recorder:
    """Writes a replay into a recording, whole columns at a time.

    Args:
        rerun: the package.
        recording: that is written to.
        replay: what is shown.
    """

    def __init__(self, rerun: Any, recording: Any, replay: Replay) -> None:
        self._rr, self._recording, self._replay = rerun, recording, replay

    def write(self, log: Log) -> None:
        """Everything: bodies with their surfaces, marks, footprints, and the curves of a log."""
        self._recording.log("scene", self._rr.ViewCoordinates.RIGHT_HAND_Z_UP, static=True)
        self._bodies()
        for track in self._replay.tracks:
            self._mark(track)
        self._footprints()
        for path, values, look in self._curves(log):
            self._recording.log(path, look, static=True)
            self._send(path, self._rr.Scalars.columns(scalars=values))

    def _send(self, path: str, columns: Any, times: Array | None = None) -> None:
        times = self._replay.time if times is None else times
        index = self._rr.TimeColumn(TIMELINE, duration=times)
        self._rr.send_columns(path, indexes=[index], columns=columns, recording=self._recording)

    def _bodies(self) -> None:
        """Transforms of the bodies that have surfaces, and these once."""
        replay, shown = self._replay, sorted({surface.body for surface in self._replay.surfaces})
        for body in shown:
            turned = np.roll(replay.body_quaternion[:, body], -1, axis=1)  # rerun has x y z w
            moved = self._rr.Transform3D.columns(translation=replay.body_position[:, body], quaternion=turned)
            self._send(self._body(body), moved)
        for index, surface in enumerate(replay.surfaces):
            mesh = self._rr.Mesh3D(
                vertex_positions=surface.vertices, triangle_indices=surface.faces, albedo_factor=rgb(surface.color)
            )
            self._recording.log(f"{self._body(surface.body)}/{index}", mesh, static=True)

    def _body(self, body: int) -> str:
        return f"scene/{'robot' if body else 'terrain'}/{self._replay.body_names[body]}"

    def _mark(self, track: Track) -> None:
        """A mark where it is, and nothing in the frames in which it is not shown."""
        path = f"scene/{track.layer}/{track.name}".replace(",", "").replace(" ", "_")
        shown = np.isfinite(track.vertices).all(axis=(1, 2))
        counts, places = shown.astype(int), track.vertices[shown]
        if not len(places):
            return
        color: dict[str, Any] = {"colors": rgb(track.color), "radii": track.size}
        if track.kind == "point":
            self._recording.log(path, self._rr.Points3D.from_fields(**color), static=True)
            columns = self._rr.Points3D.columns(positions=places[:, 0])
        elif track.kind == "arrow":
            self._recording.log(path, self._rr.Arrows3D.from_fields(**color), static=True)
            columns = self._rr.Arrows3D.columns(origins=places[:, 0], vectors=places[:, 1] - places[:, 0])
        else:
            self._recording.log(path, self._rr.LineStrips3D.from_fields(**color), static=True)
            columns = self._rr.LineStrips3D.columns(strips=np.concatenate([places, places[:, :1]], axis=1))
        self._send(path, columns.partition(counts))

    def _footprints(self) -> None:
        """Each from its touchdown on."""
        for index, footprint in enumerate(self._replay.footprints):
            path = f"scene/Taken_footprints/{index}"
            lines = self._rr.LineStrips3D(closed(footprint.corners), colors=rgb(footprint.color), radii=0.003)
            self._recording.set_time(TIMELINE, duration=max(footprint.since, float(self._replay.time[0])))
            self._recording.log(path, lines)

    def _curves(self, log: Log) -> Iterator[tuple[str, Array, Any]]:
        """Path, values and look of every curve that the log has."""
        view = beside_replay(log, self._replay)
        for index, chart in enumerate(CHARTS):
            for curve, values in chart.values(view, self._replay.time).items():
                width = 1.0 if curve.planned else 2.0
                look = self._rr.SeriesLines(colors=rgb(curve.color), names=curve.name, widths=width)
                yield f"charts/{index}/{curve.name.replace(' ', '_')}", values, look
