"""CoM law: time-varying DCM feedback through the ZMP, and a spring-damper for the height."""

import math

import numpy as np

from surefoot.maths import algebra, polygon
from surefoot.wbc.parameters import BalanceGains
from surefoot.wbc.reference import WbcReference
from surefoot.wbc.types import Array


class SupportRegion:
    """The area where the commanded ZMP may lie: convex hull of the active soles, shrunk towards each sole's centre.

    Held as its edges in the horizontal plane, rebuilt only when the contacts change. An edge is its start point, unit
    direction and length [m, -, m].
    """

    def __init__(self, half_length: float, half_width: float, share: float) -> None:
        """Soles of the given half sizes [m], of which ``share`` is used."""
        corners = np.array([[1.0, 1.0], [-1.0, 1.0], [-1.0, -1.0], [1.0, -1.0]])
        self._corners = corners * (share * np.array([half_length, half_width]))
        # Two convex soles of four corners have a hull of eight at most.
        self._points, self._vertices = np.zeros((8, 2)), np.zeros((18, 2))
        self._edges, self._count = np.zeros((8, 5)), 0

    def rebuild(
        self, positions: Array, rotations: Array, active: tuple[bool, bool], edge: tuple[int, int] = (0, 0)
    ) -> None:
        """Hull of the active soles; positions (2, 3), rotations (2, 3, 3) in the world frame.

        Of a rolling foot, its edge alone, which is where its frame is.
        """
        count = 0
        for k in range(2):
            if not active[k]:
                continue
            rolls = edge[1] != 0 if k else edge[0] != 0
            for i in range(4):
                x, y = (0.0 if rolls else self._corners[i, 0]), self._corners[i, 1]
                for j in range(2):
                    self._points[count, j] = positions[k, j] + (x * rotations[k, j, 0] + y * rotations[k, j, 1])
                count += 1
        self._count = polygon.hull(self._points, count, self._vertices)
        for k in range(self._count):
            self._write_edge(k, (k + 1) % self._count)

    def _write_edge(self, start: int, end: int) -> None:
        """Write the edge between two vertices."""
        vertices, edge = self._vertices, self._edges[start]
        x, y = vertices[end, 0] - vertices[start, 0], vertices[end, 1] - vertices[start, 1]
        length = math.hypot(x, y)
        edge[0], edge[1] = vertices[start, 0], vertices[start, 1]
        edge[2], edge[3], edge[4] = x / length, y / length, length

    def project(self, x: float, y: float, beyond: float = 0.0) -> tuple[float, float]:
        """The point nearest to (x, y) that is no farther than `beyond` from the region [m]."""
        if self._holds(x, y):
            return x, y
        nearest_x, nearest_y, least = x, y, algebra.INFINITY
        for i in range(self._count):
            edge = self._edges[i]
            along = algebra.clamp((x - edge[0]) * edge[2] + (y - edge[1]) * edge[3], 0.0, edge[4])
            at_x, at_y = edge[0] + along * edge[2], edge[1] + along * edge[3]
            distance = algebra.square(x - at_x) + algebra.square(y - at_y)
            if distance < least:
                nearest_x, nearest_y, least = at_x, at_y, distance
        share = min(1.0, beyond / max(math.sqrt(least), 1e-9))
        return nearest_x + share * (x - nearest_x), nearest_y + share * (y - nearest_y)

    def _holds(self, x: float, y: float) -> bool:
        """Return true if a point is on no edge's outer side."""
        for i in range(self._count):
            edge = self._edges[i]
            if not (x - edge[0]) * edge[3] - (y - edge[1]) * edge[2] <= 0.0:
                return False
        return True


class BalanceLaw:
    """CoM acceleration that tracks the reference.

    Horizontal: with ξ = c + c'/ω and e = ξ - ξ_ref, the pendulum's commanded point is p = p_ref + k e. It is moved so
    that the ZMP p + o, with the reference's offset o, lies in the support region. While a step catches the body the ZMP
    may lie up to `beyond_catching` beyond the region. There it is a centroidal moment pivot (Popovic, Goswami and Herr,
    International Journal of Robotics Research 2005): the force passes the CoM at a distance, and the trunk turns. Then
    c'' = c''_ref + λ (c - c_ref - p + p_ref).
    That is c'' = λ (c - p) for a reference of one instant; that of a control tick has its state at the begin and all
    else in the middle. On the reference this returns the reference's own acceleration. Since ξ' = (λ/ω)(ξ - p) for
    ω' = ω² - λ (Hopkins, Hong and Leonessa, Humanoids 2014, eq. 10), the error obeys e' = -(λ/ω)(k - 1) e.
    Vertical: c_z'' = z_ref'' + k_z (z_ref - z) + d_z (z_ref' - z').

    Args:
        gains: of the law.
        region: where the ZMP may lie; its owner keeps it up to date.
    """

    def __init__(self, gains: BalanceGains, region: SupportRegion) -> None:
        self._region = region
        self._k, self._beyond = gains.dcm, gains.beyond_catching
        self._k_z, self._d_z = gains.height_stiffness, gains.height_damping

    def acceleration(self, reference: WbcReference, c: Array, c_dot: Array) -> algebra.Vector:
        """x, y, z [m/s^2] at a CoM and its velocity, shape (3,) each [m, m/s]."""
        ref = reference
        dx, dy, dz = c[0] - ref._c[0], c[1] - ref._c[1], c[2] - ref._c[2]
        vx, vy = c_dot[0] - ref._c_dot[0], c_dot[1] - ref._c_dot[1]
        vz = c_dot[2] - ref._c_dot[2]
        px, py = ref._p[0] + ref._o[0], ref._p[1] + ref._o[1]
        zmp_x, zmp_y = self._region.project(
            px + self._k * (dx + vx / ref.omega),
            py + self._k * (dy + vy / ref.omega),
            self._beyond if ref.catching else 0.0,
        )
        return (
            ref._c_ddot[0] + ref.stiffness * (px + dx - zmp_x),
            ref._c_ddot[1] + ref.stiffness * (py + dy - zmp_y),
            ref._c_ddot[2] - self._k_z * dz - self._d_z * vz,
        )
