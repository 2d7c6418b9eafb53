cimport cython
from surefoot.maths cimport algebra
from surefoot.maths.algebra cimport vector3

cdef double _LEAST, NOWHERE

cpdef (double, double) centre_of_pressure(const double[:] wrench) noexcept nogil
@cython.locals(foot=Py_ssize_t, force=vector3, torque=vector3, moment_x=double, moment_y=double)
cpdef vector3 measured_zmp(
    const double[:, :] wrench, const double[:, :] sole_position, const double[:, :, :] sole_rotation
) noexcept nogil
