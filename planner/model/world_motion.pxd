cimport cython
from surefoot.maths cimport algebra, linear
from surefoot.maths.algebra cimport vector3

cpdef vector3 advanced(vector3 state, double jerk, double t) noexcept nogil

cdef class WorldMotion:
    cdef double _sample_time
    cdef Py_ssize_t _count
    cdef double[:, :, ::1] _com
    cdef double[:, ::1] _points

    cpdef local(self, com, velocity, acceleration, frame)
    @cython.locals(axis=Py_ssize_t)
    cdef void _see(self, const double[:] com, const double[:] velocity, const double[:] acceleration,
                   const double[:, :] R, const double[:] origin, double[:, ::1] state) noexcept nogil
    cpdef of(self, state, jerk, shifts, ahead, frame)
    @cython.locals(axis=Py_ssize_t, k=Py_ssize_t, now=vector3)
    cdef void _integrate(self, const double[:, :] state, const double[:, :] jerk) noexcept
    @cython.locals(order=Py_ssize_t, k=Py_ssize_t)
    cdef void _lift(self, const double[:, :] height, const double[:, :] R, const double[:] origin, double[:, :, ::1] com) noexcept
    @cython.locals(axis=Py_ssize_t, k=Py_ssize_t)
    cdef void _drive(self, const double[:] stiffness, const double[:, :] offset) noexcept nogil
    @cython.locals(axis=Py_ssize_t, k=Py_ssize_t)
    cdef void _shift(self, const double[:, :] point, const double[:, :] gain, const double[:, :] shifts) noexcept nogil

@cython.locals(k=Py_ssize_t)
cpdef void turn_rows(const double[:, :] R, const double[:, :] rows, double[:, :] out) noexcept nogil
@cython.locals(k=Py_ssize_t)
cpdef void place_rows(const double[:, :] R, const double[:] origin, const double[:, :] rows, double[:, :] out) noexcept nogil
