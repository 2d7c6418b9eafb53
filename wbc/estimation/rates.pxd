cimport cython
from surefoot.maths cimport algebra

cdef double IMPACT

@cython.final
cdef class RateFilter:
    cdef readonly object rate
    cdef double _noise, _more
    cdef double[::1] _rate, _variance

    @cython.locals(i=Py_ssize_t)
    cpdef void update(self, const double[:] reading, const double[:] gained, Py_ssize_t ticks) noexcept
    cdef void _take(self, Py_ssize_t i, double z, double gained, Py_ssize_t ticks) noexcept
