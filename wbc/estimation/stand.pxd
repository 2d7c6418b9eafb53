cimport cython
from surefoot.maths cimport algebra, linear

cdef Py_ssize_t TURN_AT, VELOCITY_AT, POSITION_AT, FOOT_AT, SOLE_AT, GYRO_AT, FORCE_AT, OFFSETS_AT

@cython.final
cdef class Stand:
    cdef readonly object R, columns, Z, gyro_bias, force_bias, offsets
    cdef double[:, ::1] _R, _columns, _E, _moved
    cdef double[:, :, ::1] _Z
    cdef double[::1] _gyro_bias, _force_bias, _offsets

    @cython.locals(i=Py_ssize_t, k=Py_ssize_t)
    cpdef void move(self, const double[::1] x) noexcept nogil
    cdef algebra.vector3 give(self, Py_ssize_t k, const double[:] way) noexcept nogil
    cdef void _turn(self, algebra.vector3 turned, double[:, :] R) noexcept nogil
