cimport cython
cimport libc.math as math
from surefoot cimport algebra
from surefoot.algebra cimport vector3
from surefoot.wbc cimport zmp

cdef double _SECOND, _FALLBACK

cdef class Recorder:
    cdef object _row

    cpdef tick(self, time_ns, measurement, truth, terms, planned, report, torque)

cdef class BodyRows:
    cdef const double[:] _inverse_limit
    cdef double[:, :, :] _wrench, _soles, _cop
    cdef double[:, :, :, :] _sole_rotation
    cdef double[:, :] _zmp, _normal_force, _status, _solver, _fallback, _upright, _tilt, _com, _com_velocity, _omega
    cdef double[:, :] _dcm, _q, _v, _base_position, _base_velocity, _command, _limit_ratio

    @cython.locals(n=Py_ssize_t)
    cpdef derive(self, Py_ssize_t rows)
    @cython.locals(foot=Py_ssize_t, wrench=cython.double[:, :], point=vector3)
    cdef void _feel(self, Py_ssize_t n) noexcept
    @cython.locals(axis=Py_ssize_t, k=Py_ssize_t)
    cdef void _estimate(self, Py_ssize_t n) noexcept nogil
    @cython.locals(joint=Py_ssize_t, ratio=double, most=double)
    cdef double _largest_ratio(self, Py_ssize_t n) noexcept nogil
