cimport cython
from surefoot.maths cimport algebra, linear
from surefoot.wbc.estimation.covariance cimport Covariance
from surefoot.wbc.estimation.stand cimport Stand

cdef Py_ssize_t POSE

@cython.final
cdef class InvariantFilter:
    cdef readonly Stand stand
    cdef readonly Covariance covariance
    cdef readonly object P, acceleration, residual
    cdef readonly list standing
    cdef object _ground
    cdef bint _leaning
    cdef double _gravity, _since
    cdef Py_ssize_t _taken, _count
    cdef Py_ssize_t[::1] _feet
    cdef double[:, ::1] _half, _middle, _apart
    cdef double[::1] _acceleration, _residual, _moved

    @cython.locals(i=Py_ssize_t)
    cpdef void propagate(self, const double[:] rate, const double[:] force, double time) noexcept
    @cython.locals(k=Py_ssize_t, time=double)
    cpdef void spread(self, (double, double) loads, const double[:, :] sprung=*, (bint, bint) rolling=*)
    @cython.locals(k=Py_ssize_t, ticks=double)
    cpdef weigh(self, const double[:, :, :] J)
    @cython.locals(i=Py_ssize_t, k=Py_ssize_t)
    cdef void _see(self, const double[:, :] y, const double[:, :, :] Y) noexcept nogil
    cdef double _square(self, Py_ssize_t first, Py_ssize_t end) noexcept nogil
    @cython.locals(seen=Py_ssize_t)
    cpdef tuple correct(self, const double[:, :] y, const double[:, :, :] Y, tuple gates=*)
    @cython.locals(i=Py_ssize_t)
    cdef tuple _slipped(self)
