"""Distances between the robot's own limbs as bounds on the joint accelerations of one tick."""

from collections.abc import Callable, Sequence

import numpy as np
import pinocchio as pin

from surefoot.mimic import moving_columns
from surefoot.wbc.compiled import CompiledTerms
from surefoot.wbc.model import cross
from surefoot.wbc.parameters import SeparationParameters
from surefoot.wbc.types import Array

_WORLD_AXES = pin.ReferenceFrame.LOCAL_WORLD_ALIGNED


class Separation:
    """Rows J q̈ >= lower that keep pairs of shapes apart.

    The distance d between the nearest points a and b of two shapes, with the normal n from b to a, has the rate
    d' = n·(a' - b') = J v, and d'' = J q̈ but for products of velocities (the points slide, the normal turns): below
    1 m/s^2 in walking, against (d - clearance) / T² of 8 m/s^2 at two centimetres. The approach is that of the joint
    limits, T² d'' + 2 T d' + (d - clearance) >= 0, which never comes closer than the clearance. A pair inside it is not
    pushed apart (its last term counts as zero), because two standing feet could not obey, and one that touches is left
    to the contact forces. (Faverjon and Tournassoud,
    ICRA 1987, is the first such damper on distances.)

    Attributes:
        due: pairs that have to be measured; None in plain Python, which measures all of them.
        is_clear: whether the rows that were written last hold no pair.
    """

    def __init__(
        self,
        model: pin.Model,
        geometry: pin.GeometryModel,
        parameters: SeparationParameters,
        compiled: CompiledTerms | None = None,
    ) -> None:
        """Take the shapes whose collision pairs are to be kept apart.

        Args:
            model: the robot.
            geometry: its shapes.
            parameters: when they keep apart.
            compiled: terms on which the kernel works; None for plain Python.
        """
        self._model, self._geometry, self._parameters = model, geometry, parameters
        self._data = pin.GeometryData(geometry)
        # The results are updated in place; to walk through Pinocchio's vector of them costs more than the distances.
        self._results = list(self._data.distanceResults)
        self._joints = [
            tuple(geometry.geometryObjects[shape].parentJoint for shape in (pair.first, pair.second))
            for pair in geometry.collisionPairs
        ]
        self._points = np.zeros((2, 3))
        self._written: Array | None = None
        self._filled = 0
        self.is_clear = False
        self._compiled, self._rates = compiled, dict[tuple[int, int], Callable[[], float]]()
        self.due = DuePairs(compiled, geometry, self._joints, parameters.attention) if compiled else None

    def write(self, data: pin.Data, v: Array, rows: Array, lower: Array, unbounded: float) -> None:
        """Write the rows of the nearest pairs; unused ones become zero rows without a bound.

        Args:
            data: Pinocchio's terms of the state, with joint Jacobians.
            v: generalised velocity, shape (nv,).
            rows: shape (slots, nv).
            lower: lower bounds of the rows, shape (slots,).
            unbounded: value of an absent bound.
        """
        if self.due is None:
            near = self._near(data)
            if near or not self.is_clear or self._written is not rows:
                self._fill(near, data, v, rows, lower, unbounded)
        else:
            self.write_due(self.due.find(), data, v, rows, lower, unbounded)

    def write_due(self, count: int, data: pin.Data, v: Array, rows: Array, lower: Array, unbounded: float) -> None:
        """The same where so many pairs are known to be due."""
        assert self.due is not None
        known, results, attention = self.due.distances, self._results, self._parameters.attention
        geometry, measured, near = self._geometry, self._data, []
        if count:
            pin.updateGeometryPlacements(self._model, data, geometry, measured)
            for k in self.due.numbers[:count].tolist():
                pin.computeDistance(geometry, measured, k)
                known[k] = distance = results[k].min_distance
                if 0.0 < distance < attention:
                    near.append((distance, k))
        self._fill(near, data, v, rows, lower, unbounded)

    def _near(self, data: pin.Data) -> list[tuple[float, int]]:
        """Distance and number of each pair within the attention, all of which are measured."""
        attention = self._parameters.attention
        pin.updateGeometryPlacements(self._model, data, self._geometry, self._data)
        least = pin.computeDistances(self._geometry, self._data)
        # Where not even the nearest pair is looked at, it alone has to be read.
        if least < len(self._results) and self._results[least].min_distance >= attention:
            return []
        distances = [result.min_distance for result in self._results]
        return [(distance, k) for k, distance in enumerate(distances) if 0.0 < distance < attention]

    def _fill(
        self, near: list[tuple[float, int]], data: pin.Data, v: Array, rows: Array, lower: Array, unbounded: float
    ) -> None:
        """Write the rows of pairs that are near, by distance and number."""
        p, compiled = self._parameters, self._compiled
        if self._written is not rows:
            self._written, self._filled = rows, p.slots
            self._rates.clear()
        filled, self._filled = self._filled, min(len(near), p.slots)
        self.is_clear = not near
        near.sort()
        for slot, (distance, pair) in enumerate(near[: p.slots]):
            if compiled is None:
                rows[slot] = self._gradient(data, pair)
                rate = float(rows[slot] @ v)
            else:
                result, points = self._results[pair], self._points
                points[0], points[1] = result.getNearestPoint1(), result.getNearestPoint2()
                rate = (self._rates.get((pair, slot)) or self._bound(compiled, pair, slot))()
            gap = max(distance - p.clearance, 0.0)
            lower[slot] = -2.0 / p.horizon * rate - gap / p.horizon**2
        if filled > self._filled:
            rows[self._filled :], lower[self._filled :] = 0.0, -unbounded

    def _bound(self, terms: CompiledTerms, pair: int, slot: int) -> Callable[[], float]:
        """The kernel that does what `_gradient` does for a pair in a slot, bound once it is near."""
        assert self._written is not None
        columns = [np.array(moving_columns(self._model, joint), dtype=np.int64) for joint in self._joints[pair]]
        self._rates[pair, slot] = rate = terms.kernels.bind(
            "distance_rate",
            terms=terms.bound,
            first_count=len(columns[0]),
            first_columns=columns[0],
            second_count=len(columns[1]),
            second_columns=columns[1],
            direction=self._results[pair].normal,  # where Coal keeps it
            points=self._points,
            gradient=self._written[slot],
        )
        return rate

    def _gradient(self, data: pin.Data, pair: int) -> Array:
        """Jacobian of a distance, shape (nv,)."""
        result, (one, other) = self._results[pair], self._joints[pair]
        normal = -np.asarray(result.normal)
        row = self._along(data, one, result.getNearestPoint1(), normal)
        row -= self._along(data, other, result.getNearestPoint2(), normal)
        return row

    def _along(self, data: pin.Data, joint: int, point: Array, normal: Array) -> Array:
        """From v to the rate along a normal at a point that goes with a joint, shape (nv,)."""
        arm = point - data.oMi[joint].translation
        jacobian = pin.getJointJacobian(self._model, data, joint, _WORLD_AXES)
        return np.asarray(normal.dot(jacobian[:3]) + cross(arm, normal).dot(jacobian[3:]))


class DuePairs:
    """Pairs that can have come near since their distance was measured last, which most of a robot's limbs never do.

    Args:
        compiled: terms whose joints move the shapes.
        geometry: the shapes.
        joints: those of the two shapes of each pair.
        attention: distance from which a pair is looked at [m].

    Attributes:
        distances: as measured last, shape (pairs,) [m].
        numbers: of the pairs that were found last, in its first places, shape (pairs,) [-].
        bound: these pairs as other kernels take them.
        find: finds those that are due in the state of the terms, each of which is then to be measured there; returns
            how many they are.
    """

    def __init__(
        self,
        compiled: CompiledTerms,
        geometry: pin.GeometryModel,
        joints: Sequence[tuple[int, ...]],
        attention: float,
    ) -> None:
        centres, radii = [], []
        for pair in geometry.collisionPairs:
            shape = geometry.geometryObjects[pair.second]
            shape.geometry.computeLocalAABB()
            centres.append(shape.placement.act(np.array(shape.geometry.aabb_center)))
            radii.append(shape.geometry.aabb_radius)
        poses = [compiled.pose(joint) for pair in joints for joint in pair]
        self.distances, self.numbers = np.full(len(joints), -np.inf), np.zeros(len(joints), dtype=np.int64)
        # The kernel follows addresses, so what is there must live as long as this.
        self._poses = poses
        self.bound = compiled.kernels.fill(
            "Pairs",
            count=len(joints),
            poses=np.array([part.ctypes.data for pose in poses for part in pose], dtype=np.int64),
            centres=np.array(centres).reshape(-1, 3),
            radii=np.array(radii, dtype=np.float64),
            attention=attention,
            places=np.zeros((len(joints), 12)),
            distances=self.distances,
            due=self.numbers,
        )
        self.find = compiled.kernels.bind("pairs_due", self.bound)
