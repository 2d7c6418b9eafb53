"""Tilted ground as terrain: a slope, and a field of stepping blocks."""

import math
from dataclasses import dataclass

import numpy as np

from surefoot.planner.geometry import sole_rotation
from surefoot.planner.ground.stairs import HALF_WIDTH
from surefoot.planner.ground.terrain import Box, Terrain
from surefoot.planner.types import Array
from surefoot.planner.walk.footsteps import FootstepPlan

_DEEPER = 0.05
"""How far solids reach below the ground plane at least, and the lowest blocks rise above it [m]."""

LEVEL_STEPS = 2
"""Footsteps at the end of a block field that land on level blocks, as the start feet stand on such."""


@dataclass(frozen=True, slots=True)
class Slope:
    """An inclined plane, seen from where the walk starts on level ground.

    Attributes:
        angle: inclination, positive uphill [rad].
        start: distance from the start to its edge [m].
        length: of the plane along the slope [m].
        before: depth of the platform from which a descent starts, behind the start [m].
    """

    angle: float
    start: float
    length: float
    before: float


def slope(settings: Slope, origin: Array, yaw: float, friction: float) -> Terrain:
    """A slope; one that goes down starts on a platform and meets the ground plane at its end.

    Args:
        settings: the slope.
        origin: start of the walk in the world frame, x, y, shape (2,) [m].
        yaw: heading of the slope [rad].
        friction: Coulomb coefficient of every surface [-].
    """
    heading, rotation = sole_rotation(yaw, 0.0, 0.0), sole_rotation(yaw, -settings.angle, 0.0)
    drop = max(0.0, -settings.length * math.sin(settings.angle))
    edge = heading @ (settings.start, 0.0, 0.0) + (*origin, drop)
    half = np.array(
        [0.5 * settings.length, HALF_WIDTH, 0.5 * settings.length * abs(math.tan(settings.angle)) + _DEEPER]
    )
    boxes = [Box(edge + rotation @ (half[0], 0.0, -half[2]), half, rotation)]
    if drop > 0.0:
        depth = settings.start + settings.before
        center = edge - heading @ (0.5 * depth, 0.0, 0.5 * drop)
        boxes.append(Box(center, np.array([0.5 * depth, HALF_WIDTH, 0.5 * drop]), heading))
    return Terrain(tuple(boxes), friction)


@dataclass(frozen=True, slots=True)
class Blocks:
    """Random stepping blocks, one under each footstep and a wide one under the start feet.

    Attributes:
        height: half range of the heights of their tops [m].
        angle: half range of their pitch and of their roll [rad].
        length: of a block along its footstep's heading [m].
        width: across it [m].
    """

    height: float
    angle: float
    length: float
    width: float

    @property
    def middle(self) -> float:
        """Mean height of the tops, at which the level blocks are: every corner is above the ground plane [m]."""
        return self.height + self._dip + _DEEPER

    @property
    def depth(self) -> float:
        """Thickness of a block, which reaches into the ground [m]."""
        return (self.middle + self.height + self._dip + _DEEPER) / math.cos(self.angle) ** 2

    @property
    def _dip(self) -> float:
        return 0.5 * (self.length + self.width) * math.sin(self.angle)


def block_field(blocks: Blocks, footsteps: FootstepPlan, rng: np.random.Generator, friction: float) -> Terrain:
    """Blocks whose tops have their centres at footsteps; those under the start feet and the last steps are level.

    Args:
        blocks: their size and scatter.
        footsteps: where they are; heights do not matter.
        rng: draws height, pitch and roll of every block.
        friction: Coulomb coefficient of every surface [-].
    """
    scatter = rng.uniform(-1.0, 1.0, (footsteps.steps, 3)) * (blocks.height, blocks.angle, blocks.angle)
    scatter[-LEVEL_STEPS:] = 0.0
    half = 0.5 * np.array([blocks.length, blocks.width, blocks.depth])
    first, second = footsteps.position[:2, :2]
    across = np.array([0.0, 0.5 * float(np.linalg.norm(second - first)), 0.0])
    boxes = [_block(blocks, 0.5 * (first + second), sole_rotation(float(footsteps.yaw[0]), 0.0, 0.0), half + across)]
    for position, yaw, (height, pitch, roll) in zip(footsteps.position[2:], footsteps.yaw[2:], scatter, strict=True):
        rotation = sole_rotation(float(yaw), float(pitch), float(roll))
        boxes.append(_block(blocks, position[:2], rotation, half, float(height)))
    return Terrain(tuple(boxes), friction)


def _block(blocks: Blocks, top: Array, rotation: Array, half_size: Array, height: float = 0.0) -> Box:
    """The block whose top has its centre above a point x, y and is higher than the level ones."""
    return Box(np.append(top, blocks.middle + height) - half_size[2] * rotation[:, 2], half_size, rotation)
