cimport cython
cimport libc.math as math
from surefoot.maths cimport algebra
from surefoot.maths.algebra cimport vector3
from surefoot.wbc.contact cimport zmp

cdef double _SECOND, _FALLBACK

cdef class Recorder:
    cdef object _row

    cpdef tick(self, time_ns, measurement, truth, terms, planned, report, torque)

cdef class RobotRows:
    cdef const double[:] _inverse_limit
    cdef double[:, :, :] _wrench, _soles
    cdef double[:, :, :, :] _sole_rotation
    cdef double[:, :] _zmp, _normal_force
    cdef double[:, :, :] _cop
    cdef double[:, :] _upright, _tilt, _command, _limit_ratio

    @cython.locals(n=Py_ssize_t)
    cpdef derive(self, Py_ssize_t rows)
    @cython.locals(foot=Py_ssize_t, wrench=cython.double[:, :], point=vector3)
    cdef void _feel(self, Py_ssize_t n) noexcept
    cdef void _follow(self, Py_ssize_t n) noexcept nogil
    @cython.locals(joint=Py_ssize_t, ratio=double, most=double)
    cdef double _largest_ratio(self, Py_ssize_t n) noexcept nogil

cdef class BodyRows(RobotRows):
    cdef object _com, _com_velocity, _omega, _dcm
    cdef double[:, :] _status, _solver, _fallback, _q, _v, _base_position, _base_velocity

    cpdef derive(self, Py_ssize_t rows)
    @cython.locals(k=Py_ssize_t)
    cdef void _follow(self, Py_ssize_t n) noexcept nogil
