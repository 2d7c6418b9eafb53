cimport cython
from surefoot.maths cimport algebra

cdef class DualMethod:
    cdef Py_ssize_t _most, _most_rounds, _rounds, count
    cdef double _dependent, slack, curvature, whole
    cdef Py_ssize_t[::1] active, is_active
    cdef double[::1] u, r

    @cython.locals(number=Py_ssize_t)
    cpdef Py_ssize_t iterate(self) except? -2
    @cython.locals(
        blocking=Py_ssize_t, k=Py_ssize_t, is_full=cython.bint, independent=cython.bint, multiplier=double,
        partial=double, full=double, step=double,
    )
    cdef bint _satisfy(self, Py_ssize_t number) except -1
    @cython.locals(k=Py_ssize_t, found=Py_ssize_t, least=double)
    cdef Py_ssize_t _blocking(self) noexcept
    cdef void _activate(self, Py_ssize_t number, double multiplier)
    @cython.locals(k=Py_ssize_t)
    cdef void _release(self, Py_ssize_t place)
    cdef Py_ssize_t _violated(self) except? -2
    cdef void _project(self)
    cdef void _move(self, double step)
    cdef void _take(self)
    cdef void _leave(self, Py_ssize_t place)
