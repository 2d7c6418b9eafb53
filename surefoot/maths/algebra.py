"""Numbers, vectors of three and rotations: what the laws are written in.

A vector is a tuple (x, y, z); compiled it is three numbers in registers. A rotation is an array, shape (3, 3), whose
columns are the axes of the frame that is turned.
"""

import math

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

INFINITY = math.inf

Vector = tuple[float, float, float]


def between(value: float, low: float, high: float) -> float:
    """The value nearest to one in an interval; its upper end where that is empty."""
    return min(max(value, low), high)


def clamp(value: float, low: float, high: float) -> float:
    """The value nearest to one in an interval; its lower end where that is empty and the value is below."""
    if value < low:
        return low
    return high if value > high else value


def square(value: float) -> float:
    """Its square."""
    return value * value


def add(a: Vector, b: Vector) -> Vector:
    """Sum a + b."""
    return a[0] + b[0], a[1] + b[1], a[2] + b[2]


def subtract(a: Vector, b: Vector) -> Vector:
    """Difference a - b."""
    return a[0] - b[0], a[1] - b[1], a[2] - b[2]


def scale(factor: float, a: Vector) -> Vector:
    """A factor times a."""
    return factor * a[0], factor * a[1], factor * a[2]


def squares(a: Vector) -> Vector:
    """The square of each number."""
    return a[0] * a[0], a[1] * a[1], a[2] * a[2]


def cross(a: Vector, b: Vector) -> Vector:
    """Cross product a x b."""
    return a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]


def inner(a: Vector, b: Vector) -> float:
    """Inner product a' b."""
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def vector(values: Array) -> Vector:
    """An array of three numbers as a vector."""
    return values[0], values[1], values[2]


def put(out: Array, a: Vector) -> None:
    """Write a vector into an array, shape (3,)."""
    out[0], out[1], out[2] = a[0], a[1], a[2]


def row(A: Array, i: int, first: int = 0) -> Vector:
    """Three numbers of a row of a matrix, from a column on."""
    return A[i, first], A[i, first + 1], A[i, first + 2]


def put_row(A: Array, i: int, a: Vector, first: int = 0) -> None:
    """Write a vector into a row of a matrix, from a column on."""
    A[i, first], A[i, first + 1], A[i, first + 2] = a[0], a[1], a[2]


def column(A: Array, j: int, first: int = 0) -> Vector:
    """Three numbers of a column of a matrix, from a row on."""
    return A[first, j], A[first + 1, j], A[first + 2, j]


def put_column(A: Array, j: int, a: Vector, first: int = 0) -> None:
    """Write a vector into a column of a matrix, from a row on."""
    A[first, j], A[first + 1, j], A[first + 2, j] = a[0], a[1], a[2]


def put_cross(out: Array, a: Vector) -> None:
    """Write hat(a) into an array, shape (3, 3): hat(a) b is a x b."""
    out[0, 0], out[0, 1], out[0, 2] = 0.0, -a[2], a[1]
    out[1, 0], out[1, 1], out[1, 2] = a[2], 0.0, -a[0]
    out[2, 0], out[2, 1], out[2, 2] = -a[1], a[0], 0.0


def rotate(R: Array, a: Vector) -> Vector:
    """R a."""
    return (
        R[0, 0] * a[0] + R[0, 1] * a[1] + R[0, 2] * a[2],
        R[1, 0] * a[0] + R[1, 1] * a[1] + R[1, 2] * a[2],
        R[2, 0] * a[0] + R[2, 1] * a[1] + R[2, 2] * a[2],
    )


def rotate_back(R: Array, a: Vector) -> Vector:
    """R' a."""
    return (
        R[0, 0] * a[0] + R[1, 0] * a[1] + R[2, 0] * a[2],
        R[0, 1] * a[0] + R[1, 1] * a[1] + R[2, 1] * a[2],
        R[0, 2] * a[0] + R[1, 2] * a[1] + R[2, 2] * a[2],
    )


def compose(A: Array, B: Array, out: Array) -> None:
    """A B, of two rotations, neither of which is `out`."""
    for i in range(3):
        for j in range(3):
            out[i, j] = A[i, 0] * B[0, j] + A[i, 1] * B[1, j] + A[i, 2] * B[2, j]


def compose_back(A: Array, B: Array, out: Array) -> None:
    """A' B, of two rotations, neither of which is `out`."""
    for i in range(3):
        for j in range(3):
            out[i, j] = A[0, i] * B[0, j] + A[1, i] * B[1, j] + A[2, i] * B[2, j]


def rotation_of(a: Vector, R: Array) -> None:
    """Write into R the rotation by a rotation vector, as `pinocchio.exp3` has it."""
    x, y, z = a
    squared = x * x + y * y + z * z
    angle = math.sqrt(squared)
    small = angle < 1e-4
    half = math.sin(0.5 * angle)
    first = 1.0 - squared / 6.0 if small else math.sin(angle) / angle
    second = 0.5 - squared / 24.0 if small else 2.0 * half * half / squared
    cosine = 1.0 - second * squared
    R[0, 0], R[0, 1], R[0, 2] = second * x * x + cosine, second * x * y - first * z, second * x * z + first * y
    R[1, 0], R[1, 1], R[1, 2] = second * y * x + first * z, second * y * y + cosine, second * y * z - first * x
    R[2, 0], R[2, 1], R[2, 2] = second * z * x - first * y, second * z * y + first * x, second * z * z + cosine


def quaternion_rows(x: float, y: float, z: float, w: float) -> tuple[Vector, Vector, Vector]:
    """Rows of the rotation of a unit quaternion."""
    return (
        (1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - w * z), 2.0 * (x * z + w * y)),
        (2.0 * (x * y + w * z), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - w * x)),
        (2.0 * (x * z - w * y), 2.0 * (y * z + w * x), 1.0 - 2.0 * (x * x + y * y)),
    )


def rotation_vector(R: Array) -> Vector:
    """Rotation vector of a rotation, as `pinocchio.log3` has it for angles below pi."""
    return _logarithm((R[2, 1] - R[1, 2], R[0, 2] - R[2, 0], R[1, 0] - R[0, 1]), R[0, 0] + R[1, 1] + R[2, 2])


def turn_between(A: Array, B: Array) -> Vector:
    """Rotation vector of A' B: how B is turned from A, in the frame of A."""
    axis = (
        columns_inner(A, 2, B, 1) - columns_inner(A, 1, B, 2),
        columns_inner(A, 0, B, 2) - columns_inner(A, 2, B, 0),
        columns_inner(A, 1, B, 0) - columns_inner(A, 0, B, 1),
    )
    return _logarithm(axis, columns_inner(A, 0, B, 0) + columns_inner(A, 1, B, 1) + columns_inner(A, 2, B, 2))


def columns_inner(A: Array, i: int, B: Array, j: int) -> float:
    """Inner product of a column of one rotation with a column of another one."""
    found: float = A[0, i] * B[0, j] + A[1, i] * B[1, j] + A[2, i] * B[2, j]
    return found


def _logarithm(axis: Vector, trace: float) -> Vector:
    """Rotation vector of a rotation R, from the vector of R - R' and its trace."""
    sine = 0.5 * math.sqrt(inner(axis, axis))
    cosine = 0.5 * (trace - 1.0)
    factor = 0.5 if sine < 1e-8 else 0.5 * math.atan2(sine, cosine) / sine
    return scale(factor, axis)


def see_motion(R: Array, p: Vector, linear: Vector, angular: Vector) -> tuple[Vector, Vector]:
    """A motion as seen from a frame with rotation R and origin p: R' (v - p x ω) and R' ω."""
    return rotate_back(R, subtract(linear, cross(p, angular))), rotate_back(R, angular)


def see_wrench(R: Array, p: Vector, out: Array) -> None:
    """Write the map of a wrench in a frame to force and moment about the origin into an array, shape (6, 6).

    It is [R, 0; [p]x R, R], with rotation R and origin p of the frame.
    """
    for j in range(3):
        axis = column(R, j)
        lever = cross(p, axis)
        out[0, j], out[1, j], out[2, j] = axis[0], axis[1], axis[2]
        out[0, 3 + j], out[1, 3 + j], out[2, 3 + j] = 0.0, 0.0, 0.0
        out[3, j], out[4, j], out[5, j] = lever[0], lever[1], lever[2]
        out[3, 3 + j], out[4, 3 + j], out[5, 3 + j] = axis[0], axis[1], axis[2]


def quaternion(R: Array, out: Array) -> None:
    """Write x, y, z, w of a rotation, as Eigen and `pinocchio.SE3ToXYZQUAT` have it, into an array, shape (4,)."""
    trace = R[0, 0] + R[1, 1] + R[2, 2]
    if trace > 0.0:
        root = math.sqrt(trace + 1.0)
        out[3] = 0.5 * root
        root = 0.5 / root
        out[0] = (R[2, 1] - R[1, 2]) * root
        out[1] = (R[0, 2] - R[2, 0]) * root
        out[2] = (R[1, 0] - R[0, 1]) * root
        return
    i = 1 if R[1, 1] > R[0, 0] else 0
    if R[2, 2] > R[i, i]:
        i = 2
    j = (i + 1) % 3
    k = (j + 1) % 3
    root = math.sqrt(R[i, i] - R[j, j] - R[k, k] + 1.0)
    out[i] = 0.5 * root
    root = 0.5 / root
    out[3] = (R[k, j] - R[j, k]) * root
    out[j] = (R[j, i] + R[i, j]) * root
    out[k] = (R[k, i] + R[i, k]) * root
