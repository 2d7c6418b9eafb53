"""CoM law: time-varying DCM feedback through the ZMP, and a spring-damper for the height."""

import math
from collections.abc import Callable, Sequence

import numpy as np

from surefoot.native.library import Library, library
from surefoot.polygon import convex_hull
from surefoot.wbc.parameters import BalanceGains
from surefoot.wbc.types import Array, WbcReference


class SupportRegion:
    """The area where the commanded ZMP may lie: convex hull of the active soles, shrunk towards each sole's centre.

    Held as its edges in the horizontal plane, rebuilt only when the contacts change. Plain floats, since arrays of two
    numbers cost more than their arithmetic.

    Attributes:
        edges: the same for kernels: start point, unit direction and length of each edge, shape (8, 5) [m, -, m].
        edge_count: how many of them there are, shape (1,).
    """

    def __init__(self, half_length: float, half_width: float, share: float) -> None:
        """Soles of the given half sizes [m], of which ``share`` is used."""
        corners = np.array([[1.0, 1.0], [-1.0, 1.0], [-1.0, -1.0], [1.0, -1.0]])
        self._corners = corners * (share * np.array([half_length, half_width]))
        self._edges: list[_Edge] = []
        # Two convex soles of four corners have a hull of eight at most.
        self.edges, self.edge_count = np.zeros((8, 5)), np.zeros(1, dtype=np.int64)
        self._positions, self._rotations = np.zeros((2, 3)), np.zeros((2, 3, 3))
        kernels = library()
        self._rebuild = None if kernels is None else self._compile(kernels)

    def _compile(self, kernels: Library) -> Callable[[bool, bool, int], None]:
        """The kernel that does what `rebuild` does."""
        return kernels.bind(
            "support_rebuild",
            corners=self._corners,
            positions=self._positions,
            rotations=self._rotations,
            edges=self.edges,
            edge_count=self.edge_count,
        )

    def rebuild(self, positions: Array, rotations: Array, active: tuple[bool, bool], rolling: int = -1) -> None:
        """Hull of the active soles; positions (2, 3), rotations (2, 3, 3) in the world frame.

        Of a rolling foot, the toe edge alone, which is where its frame is.
        """
        if self._rebuild is not None:
            self._positions[:], self._rotations[:] = positions, rotations
            self._rebuild(*active, rolling)
            self._edges = self.edges[: self.edge_count[0]].tolist()
            return
        edge = self._corners * np.array([0.0, 1.0])
        corners = [edge if k == rolling else self._corners for k in (0, 1)]
        soles = [positions[k, :2] + corners[k] @ rotations[k, :2, :2].T for k in (0, 1) if active[k]]
        vertices = convex_hull(np.concatenate(soles)).tolist()
        self._edges = [_edge(*start, *end) for start, end in zip(vertices, vertices[1:] + vertices[:1], strict=True)]
        self.edge_count[0] = len(self._edges)
        self.edges[: len(self._edges)] = self._edges

    def project(self, x: float, y: float, beyond: float = 0.0) -> tuple[float, float]:
        """The point nearest to (x, y) that is no farther than `beyond` from the region [m]."""
        for ex, ey, ux, uy, _ in self._edges:
            if not (x - ex) * uy - (y - ey) * ux <= 0.0:
                break
        else:
            return x, y
        nearest, least = (x, y), math.inf
        for ex, ey, ux, uy, length in self._edges:
            along = min(max((x - ex) * ux + (y - ey) * uy, 0.0), length)
            px, py = ex + along * ux, ey + along * uy
            distance = (x - px) ** 2 + (y - py) ** 2
            if distance < least:
                nearest, least = (px, py), distance
        px, py = nearest
        share = min(1.0, beyond / max(math.sqrt(least), 1e-9))
        return px + share * (x - px), py + share * (y - py)


_Edge = Sequence[float]
"""Start point, unit direction and length of an edge of a counter-clockwise polygon."""


def _edge(start_x: float, start_y: float, end_x: float, end_y: float) -> _Edge:
    length = math.hypot(end_x - start_x, end_y - start_y)
    return start_x, start_y, (end_x - start_x) / length, (end_y - start_y) / length, length


def com_acceleration(
    reference: WbcReference, com: Array, com_velocity: Array, region: SupportRegion, gains: BalanceGains
) -> tuple[float, float, float]:
    """CoM acceleration that tracks the reference.

    Horizontal: with ξ = c + c'/ω and e = ξ - ξ_ref, the pendulum's commanded point is p = p_ref + k e, moved so that
    the ZMP p + o with the reference's offset o lies in the support region, or up to `beyond_catching` beyond it while a
    step catches the body: there it is a centroidal moment pivot (Popovic, Goswami and Herr, International Journal of
    Robotics Research 2005), the force passes the CoM at a distance, and the trunk turns. Then
    c'' = c''_ref + λ (c - c_ref - p + p_ref).
    That is c'' = λ (c - p) for a reference of one instant; that of a control tick has its state at the begin and all
    else in the middle. On the reference this returns the reference's own acceleration. Since ξ' = (λ/ω)(ξ - p) for
    ω' = ω² - λ (Hopkins, Hong and Leonessa, Humanoids 2014, eq. 10), the error obeys e' = -(λ/ω)(k - 1) e.
    Vertical: c_z'' = z_ref'' + k_z (z_ref - z) + d_z (z_ref' - z').

    Args:
        reference: what to track.
        com: measured CoM, shape (3,) [m].
        com_velocity: its velocity, shape (3,) [m/s].
        region: where the ZMP may lie.
        gains: of the law.

    Returns:
        x, y, z [m/s^2].
    """
    (x, y, z), (x_ref, y_ref, z_ref) = com.tolist(), reference.com.tolist()
    (vx, vy, vz), (vx_ref, vy_ref, vz_ref) = com_velocity.tolist(), reference.com_velocity.tolist()
    dx, dy, dz, vx, vy, vz = x - x_ref, y - y_ref, z - z_ref, vx - vx_ref, vy - vy_ref, vz - vz_ref
    px, py = reference.zmp.tolist()
    offset_x, offset_y = reference.zmp_offset.tolist()
    zmp_x, zmp_y = region.project(
        px + offset_x + gains.dcm * (dx + vx / reference.omega),
        py + offset_y + gains.dcm * (dy + vy / reference.omega),
        gains.beyond_catching if reference.catching else 0.0,
    )
    ax, ay, planned = reference.com_acceleration.tolist()
    return (
        ax + reference.stiffness * (px + offset_x + dx - zmp_x),
        ay + reference.stiffness * (py + offset_y + dy - zmp_y),
        planned - gains.height_stiffness * dz - gains.height_damping * vz,
    )
