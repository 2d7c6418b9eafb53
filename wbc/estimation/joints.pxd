cimport cython
from surefoot.maths cimport linear
from surefoot.readings cimport Readings

@cython.final
cdef class JointObserver:
    cdef readonly object position, velocity
    cdef readonly double bandwidth, rate_noise
    cdef double _period, _moved, _sped
    cdef Py_ssize_t _tick, _at, _count
    cdef double[:, ::1] _accelerations
    cdef double[::1] _still, _q, _v, _q_now, _v_now

    cpdef void drive(self, const double[:] acceleration)
    @cython.locals(at=Py_ssize_t, tick=Py_ssize_t)
    cpdef update(self, Readings readings)
    cdef void _take(self, Py_ssize_t at, const double[:] position, const double[:] velocity)
    @cython.locals(newer=cython.bint, tick=Py_ssize_t, i=Py_ssize_t)
    cdef void _hear(self, Py_ssize_t at, const double[:] reading, bint fresh) noexcept
    @cython.locals(back=Py_ssize_t, kept=Py_ssize_t, T=double, known=cython.bint, u=double[::1])
    cdef void _go_on(self, Py_ssize_t tick, double[::1] q, double[::1] v) noexcept
