"""Distances between the robot's own limbs as bounds on the joint accelerations of one tick."""

import math

import numpy as np
import pinocchio as pin
from numpy.typing import NDArray

from surefoot.engines.mimic import JointColumns, moving_columns
from surefoot.maths import algebra, linear
from surefoot.wbc.parameters import SeparationParameters
from surefoot.wbc.types import Array


class Separation:
    """Rows J q̈ >= lower that keep pairs of shapes apart.

    The distance d between the nearest points a and b of two shapes, with the normal n from b to a, has the rate
    d' = n·(a' - b') = J v, and d'' = J q̈ but for products of velocities (the points slide, the normal turns): below
    1 m/s^2 in walking, against (d - clearance) / T² of 8 m/s^2 at two centimetres. The approach is that of the joint
    limits, T² d'' + 2 T d' + (d - clearance) >= 0, which never comes closer than the clearance. A pair inside it is not
    pushed apart: its last term counts as zero, because two standing feet could not obey. A pair that touches is left to
    the contact forces. (Faverjon and Tournassoud, ICRA 1987, is the first such damper on distances.)

    Attributes:
        is_clear: whether the rows that were written last hold no pair.
    """

    def __init__(self, model: pin.Model, geometry: pin.GeometryModel, parameters: SeparationParameters) -> None:
        """Take the shapes whose collision pairs are to be kept apart.

        Args:
            model: the robot.
            geometry: its shapes.
            parameters: when they keep apart.
        """
        self._model, self._geometry, self._parameters = model, geometry, parameters
        self._shapes = pin.GeometryData(geometry)
        # The results are updated in place; to walk through Pinocchio's vector of them costs more than the distances.
        self._results = list(self._shapes.distanceResults)
        self._data: pin.Data | None = None
        self._joints: JointColumns | None = None
        self._pairs: list[Pair] = []
        self._attention = parameters.attention
        self._written: Array | None = None
        self._filled = 0
        self.is_clear = False

    def write(self, data: pin.Data, v: Array, rows: Array, lower: Array, unbounded: float) -> None:
        """Write the rows of the nearest pairs; unused ones become zero rows without a bound.

        Args:
            data: Pinocchio's terms of the state, with joint Jacobians; best the same at each call.
            v: generalised velocity, shape (nv,).
            rows: shape (slots, nv).
            lower: lower bounds of the rows, shape (slots,).
            unbounded: value of an absent bound.
        """
        if data is not self._data:
            self.look_into(data)
        due = self.due()
        if due or not self.is_clear or self._written is not rows:
            self._fill(self._near(due), v, rows, lower, unbounded)

    def look_into(self, data: pin.Data) -> None:
        """Take the terms of which the states will be; none of the pairs has been measured then."""
        self._data, self._joints = data, JointColumns(self._model, data)
        J, pairs = self._joints.values, self._geometry.collisionPairs
        self._pairs = [Pair(self._model, data, J, self._geometry, pair) for pair in pairs]

    def due(self) -> list[int]:
        """Numbers of the pairs that may have come near since they were measured, each of which is to be measured."""
        found = []
        for k in range(len(self._pairs)):
            pair = self._pairs[k]
            if pair.is_due(self._attention):
                found.append(k)
        return found

    def _near(self, due: list[int]) -> list[tuple[float, int]]:
        """Distance and number of each pair within the attention, once those that are due are measured."""
        if not due:
            return []
        pin.updateGeometryPlacements(self._model, self._data, self._geometry, self._shapes)
        near = []
        for k in due:
            pin.computeDistance(self._geometry, self._shapes, k)
            pair, distance = self._pairs[k], self._results[k].min_distance
            pair.distance = distance
            if 0.0 < distance < self._attention:
                near.append((distance, k))
        return near

    def _fill(self, near: list[tuple[float, int]], v: Array, rows: Array, lower: Array, unbounded: float) -> None:
        """Write the rows of pairs that are near, by distance and number."""
        p = self._parameters
        if self._written is not rows:
            self._written, self._filled = rows, p.slots
        filled, self._filled = self._filled, min(len(near), p.slots)
        self.is_clear = not near
        near.sort()
        if near:
            assert self._joints is not None
            self._joints.update()
        for slot, (distance, k) in enumerate(near[: p.slots]):
            result = self._results[k]
            normal, first, second = result.normal, result.getNearestPoint1(), result.getNearestPoint2()
            pair = self._pairs[k]
            rate = pair.rate(normal, first, second, v, rows, slot)
            gap = max(distance - p.clearance, 0.0)
            lower[slot] = -2.0 / p.horizon * rate - gap / p.horizon**2
        if filled > self._filled:
            rows[self._filled :], lower[self._filled :] = 0.0, -unbounded


class Pair:
    """Two shapes on two bodies, which most of the time cannot have come near since their distance was measured.

    A distance changes by no more than a point of the second shape moves, seen from the first body: its centre, and as
    far as the farthest point from that turns.

    Args:
        model: the robot.
        data: where Pinocchio places its joints.
        jacobian: columns of the joints, the values of `JointColumns`, shape (6, nv).
        geometry: the shapes.
        pair: their numbers.

    Attributes:
        distance: as measured last [m].
    """

    def __init__(
        self, model: pin.Model, data: pin.Data, jacobian: Array, geometry: pin.GeometryModel, pair: pin.CollisionPair
    ) -> None:
        shapes = [geometry.geometryObjects[k] for k in (pair.first, pair.second)]
        (one, other), far = (shape.parentJoint for shape in shapes), shapes[1]
        far.geometry.computeLocalAABB()
        self._centre = algebra.vector(far.placement.act(np.array(far.geometry.aabb_center)))
        self._radius, self.distance = far.geometry.aabb_radius, -math.inf
        # Views of Pinocchio's memory, which never moves.
        self._R_1, self._p_1 = data.oMi[one].rotation, data.oMi[one].translation
        self._R_2, self._p_2 = data.oMi[other].rotation, data.oMi[other].translation
        self._jacobian = jacobian
        self._columns_1, self._columns_2 = (
            np.array(moving_columns(model, joint), dtype=np.int64) for joint in (one, other)
        )
        self._R, self._p = np.zeros((3, 3)), (0.0, 0.0, 0.0)

    def is_due(self, attention: float) -> bool:
        """Return true if the distance may be less than that [m]; what is due is taken as measured in this place."""
        turned = linear.distance_squared(self._R_1, self._R_2, self._R)
        now = self._seen()
        moved = algebra.subtract(now, self._p)
        most = math.sqrt(algebra.inner(moved, moved)) + self._radius * math.sqrt(0.5 * turned)
        if self.distance - most > attention:
            return False
        algebra.compose_back(self._R_1, self._R_2, self._R)
        self._p = now
        return True

    def _seen(self) -> algebra.Vector:
        """Centre of the second shape as seen from the first body, R_1' (p_2 - p_1 + R_2 c) [m]."""
        x, y, z = self._lever(0), self._lever(1), self._lever(2)
        return (
            self._R_1[0, 0] * x + self._R_1[1, 0] * y + self._R_1[2, 0] * z,
            self._R_1[0, 1] * x + self._R_1[1, 1] * y + self._R_1[2, 1] * z,
            self._R_1[0, 2] * x + self._R_1[1, 2] * y + self._R_1[2, 2] * z,
        )

    def _lever(self, i: int) -> float:
        """The same in the world, along an axis [m]."""
        c, apart = self._centre, self._p_2[i] - self._p_1[i]
        lever: float = apart + self._R_2[i, 0] * c[0] + self._R_2[i, 1] * c[1] + self._R_2[i, 2] * c[2]
        return lever

    def rate(self, direction: Array, first: Array, second: Array, v: Array, rows: Array, slot: int) -> float:
        """Write the Jacobian of the distance into a row; the rate of the distance [m/s].

        Args:
            direction: from the nearest point of the first shape to that of the second one, shape (3,).
            first: nearest point of the first shape, in the world, shape (3,) [m].
            second: nearest point of the second shape, in the world, shape (3,) [m].
            v: generalised velocity, shape (nv,).
            rows: shape (slots, nv).
            slot: number of the row.
        """
        rows[slot, :] = 0.0
        normal = algebra.scale(-1.0, algebra.vector(direction))
        self._add_point(1.0, normal, algebra.vector(first), self._columns_1, rows, slot)
        self._add_point(-1.0, normal, algebra.vector(second), self._columns_2, rows, slot)
        return linear.row_dot(rows, slot, v)

    def _add_point(
        self, sign: float, n: algebra.Vector, point: algebra.Vector, columns: NDArray[np.int64], rows: Array, slot: int
    ) -> None:
        """Add n'(J v) of a point of a body, whose joints have these columns: n'v + (p x n)'ω."""
        J, lever = self._jacobian, algebra.cross(point, n)
        for i in range(columns.shape[0]):
            j = columns[i]
            along = n[0] * J[0, j] + lever[0] * J[3, j]
            along += n[1] * J[1, j] + lever[1] * J[4, j]
            along += n[2] * J[2, j] + lever[2] * J[5, j]
            rows[slot, j] += sign * along
