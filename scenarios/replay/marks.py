"""A frame of a replay as marks for MuJoCo's pictures."""

import itertools
from collections.abc import Iterator

import numpy as np

from scenarios.replay.content import Array, Color, Replay, Track
from sim.marks import Mark

TRAIL_STEP, TRAIL_LENGTH = 3, 300
"""Frames between the points of a trail, and frames that it reaches back."""

TRAIL_RADIUS = 0.0025
OUTLINE_RADIUS = 0.004


def marks_of(replay: Replay, frame: int) -> Iterator[Mark]:
    """Everything beside the robot that a frame shows."""
    for track in replay.tracks:
        if track.shown(frame):
            yield from _mark(track, frame)
        if track.trail:
            path = track.path(slice(max(frame % TRAIL_STEP, frame - TRAIL_LENGTH), frame + 1, TRAIL_STEP))
            for ends in itertools.pairwise(path):
                yield Mark("line", track.color, TRAIL_RADIUS, np.stack(ends))
    for footprint in replay.footprints:
        if footprint.since <= replay.time[frame] + 1e-9:
            yield from _outline(footprint.color, OUTLINE_RADIUS, footprint.corners)


def _mark(track: Track, frame: int) -> Iterator[Mark]:
    vertices = track.vertices[frame]
    if track.kind == "outline":
        yield from _outline(track.color, track.size, vertices)
    else:
        yield Mark(track.kind, track.color, track.size, vertices)


def _outline(color: Color, size: float, vertices: Array) -> Iterator[Mark]:
    """Lines along the edges that have a length; two vertices make one line."""
    following = np.roll(vertices, -1, axis=0)
    for ends in np.stack([vertices, following], axis=1)[: len(vertices) if len(vertices) > 2 else 1]:
        if np.ptp(ends, axis=0).any():
            yield Mark("line", color, size, ends)
