import numpy as np
import pytest
import qpsolvers

from surefoot.wbc.contact.cone import CONE_ROWS, wrench_cone

pytestmark = pytest.mark.unit

X, Y, MU = 0.11, 0.055, 0.5
CORNERS = np.array([[X, Y], [-X, Y], [-X, -Y], [X, -Y]])


def wrench_map() -> np.ndarray:
    """Map from the four corner forces, shape (12,), to the wrench at the sole centre, shape (6,)."""
    rows = np.zeros((6, 12))
    for i, (x, y) in enumerate(CORNERS):
        rows[:3, 3 * i : 3 * i + 3] = np.eye(3)
        rows[3:, 3 * i : 3 * i + 3] = [[0, 0, y], [0, 0, -x], [-y, x, 0]]
    return rows


def pyramids() -> np.ndarray:
    """Rows G with G f <= 0 for four unilateral friction pyramids."""
    one = np.array([[1, 0, -MU], [-1, 0, -MU], [0, 1, -MU], [0, -1, -MU], [0, 0, -1]])
    return np.kron(np.eye(4), one)


def corner_forces_exist(wrench: np.ndarray) -> bool:
    """Return true if four frictional point contacts at the corners can produce the wrench."""
    G = pyramids()
    P = 1e-6 * np.eye(12)
    solution = qpsolvers.solve_qp(P, np.zeros(12), G, np.zeros(len(G)), wrench_map(), wrench, solver="daqp")
    return solution is not None


def test_the_cone_holds_every_wrench_of_corner_forces():
    rng = np.random.default_rng(0)
    cone = wrench_cone(X, Y, MU)
    assert cone.shape == (CONE_ROWS, 6)
    fz = rng.uniform(0, 500, (2000, 4))
    f = np.stack([rng.uniform(-MU, MU, fz.shape) * fz, rng.uniform(-MU, MU, fz.shape) * fz, fz], axis=-1)
    wrenches = f.reshape(len(f), 12) @ wrench_map().T
    assert (wrenches @ cone.T).max() <= 1e-9


def test_the_cone_agrees_with_corner_forces_inside_and_outside():
    rng = np.random.default_rng(1)
    cone = wrench_cone(X, Y, MU)
    scale = np.array([MU, MU, 1, Y, X, MU * (X + Y)]) * 300
    inside = 0
    for _ in range(300):
        wrench = scale * rng.uniform(-1, 1, 6)
        wrench[2] = 300
        margin = (cone @ wrench).max()
        if abs(margin) < 0.5:
            continue
        inside += margin < 0
        assert corner_forces_exist(wrench) == (margin < 0)
    assert 20 < inside < 280


def test_pulling_is_outside():
    assert (wrench_cone(X, Y, MU) @ np.array([0, 0, -1.0, 0, 0, 0])).max() > 0


@pytest.mark.parametrize("size", [(0, Y, MU), (X, -1, MU), (X, Y, 0)])
def test_degenerate_soles_are_refused(size):
    with pytest.raises(ValueError, match="must be positive"):
        wrench_cone(*size)
