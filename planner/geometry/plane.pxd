cimport cython
cimport libc.math as math
from surefoot.maths cimport algebra, linear
from surefoot.maths.algebra cimport vector3

cpdef void turn_plane(double yaw, double[:, ::1] R) noexcept nogil
@cython.locals(k=Py_ssize_t)
cpdef void place_points(
    const double[:] origin, const double[:, :] R, const double[:, :] points, double[:, ::1] placed
) noexcept nogil
@cython.locals(k=Py_ssize_t, first=vector3, second=vector3, third=vector3)
cpdef void turn_each(const double[:, :] quaternions, double[:, :, ::1] R) noexcept nogil
@cython.locals(i=Py_ssize_t, k=Py_ssize_t, power=double)
cpdef void expand(double time, const double[:, ::1] binomial, double[:, ::1] A) noexcept nogil
