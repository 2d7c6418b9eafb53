"""CoM law: time-varying DCM feedback through the ZMP, and a spring-damper for the height."""

from dataclasses import dataclass

import numpy as np
from scipy.spatial import ConvexHull

from wbc.types import Array, WbcReference


@dataclass(frozen=True, slots=True)
class BalanceGains:
    """Gains of the CoM law.

    Attributes:
        dcm: ZMP moved per DCM error [-]; above 1 the DCM error decays, at rate (dcm - 1) ω.
        height_stiffness: vertical stiffness per mass [1/s^2].
        height_damping: vertical damping per mass [1/s].
        polygon_share: share of the support polygon that the commanded ZMP may use [-].
    """

    dcm: float = 3.0
    height_stiffness: float = 60.0
    height_damping: float = 15.0
    polygon_share: float = 0.95


class SupportRegion:
    """The area where the commanded ZMP may lie: convex hull of the active soles, shrunk towards each sole's centre.

    Held as half-planes and vertices in the horizontal plane, rebuilt only when the contacts change.
    """

    def __init__(self, half_length: float, half_width: float, share: float) -> None:
        """Soles of the given half sizes [m], of which ``share`` is used."""
        corners = np.array([[1.0, 1.0], [-1.0, 1.0], [-1.0, -1.0], [1.0, -1.0]])
        self._corners = corners * (share * np.array([half_length, half_width]))
        self._normals = np.zeros((0, 2))
        self._offsets = np.zeros(0)
        self._vertices = np.zeros((0, 2))

    def rebuild(self, positions: Array, rotations: Array, active: tuple[bool, bool]) -> None:
        """Hull of the active soles; positions (2, 3), rotations (2, 3, 3) in the world frame."""
        soles = [positions[k, :2] + self._corners @ rotations[k, :2, :2].T for k in (0, 1) if active[k]]
        points = np.concatenate(soles)
        self._vertices = points[ConvexHull(points).vertices]
        edges = np.roll(self._vertices, -1, axis=0) - self._vertices
        lengths = np.linalg.norm(edges, axis=1)
        self._normals = np.column_stack([edges[:, 1], -edges[:, 0]]) / lengths[:, None]
        self._offsets = np.einsum("ij,ij->i", self._normals, self._vertices)

    def project(self, point: Array) -> Array:
        """The point of the region nearest to ``point``, shape (2,)."""
        if (self._normals @ point <= self._offsets).all():
            return point
        start = self._vertices
        edge = np.roll(start, -1, axis=0) - start
        along = np.einsum("ij,ij->i", point - start, edge) / np.einsum("ij,ij->i", edge, edge)
        nearest = start + np.clip(along, 0.0, 1.0)[:, None] * edge
        return nearest[np.argmin(np.einsum("ij,ij->i", nearest - point, nearest - point))]


def com_acceleration(
    reference: WbcReference, com: Array, com_velocity: Array, region: SupportRegion, gains: BalanceGains
) -> Array:
    """CoM acceleration that tracks the reference.

    Horizontal: with ξ = c + c'/ω and e = ξ - ξ_ref, the commanded ZMP is p = p_ref + k e, projected on the support
    region, and c'' = λ (c - p). On the reference this returns the reference's own acceleration. Since ξ' = (λ/ω)(ξ - p) for
    ω' = ω² - λ (Hopkins, Hong and Leonessa, Humanoids 2014, eq. 10), the error obeys e' = -(λ/ω)(k - 1) e.
    Vertical: c_z'' = z_ref'' + k_z (z_ref - z) + d_z (z_ref' - z').

    Args:
        reference: what to track.
        com: measured CoM, shape (3,) [m].
        com_velocity: its velocity, shape (3,) [m/s].
        region: where the ZMP may lie.
        gains: of the law.

    Returns:
        Shape (3,) [m/s^2].
    """
    position_error = com - reference.com
    velocity_error = com_velocity - reference.com_velocity
    dcm_error = position_error[:2] + velocity_error[:2] / reference.omega
    zmp = region.project(reference.zmp + gains.dcm * dcm_error)
    acceleration = np.empty(3)
    acceleration[:2] = reference.stiffness * (com[:2] - zmp)
    acceleration[2] = (
        reference.com_acceleration[2]
        - gains.height_stiffness * position_error[2]
        - gains.height_damping * velocity_error[2]
    )
    return acceleration
