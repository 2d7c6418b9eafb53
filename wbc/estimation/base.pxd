cimport cython
from surefoot cimport algebra, linear
from surefoot.wbc.estimation.stand cimport Stand

@cython.final
cdef class FloatingBase:
    cdef readonly object q, v
    cdef Stand _stand
    cdef const Py_ssize_t[::1] _chain
    cdef const double[::1] _rate
    cdef double[:, ::1] _mount, _R, _mounted, _turn, _half
    cdef double[::1] _q, _v, _lever
    cdef double _farthest, _fastest

    cpdef state(self, const double[:] position, const double[:] velocity, const double[:] gained, double late)
    cdef void _place(self) noexcept
    cdef void _go_on(self, const double[:] gained, double late) noexcept nogil
    @cython.locals(i=Py_ssize_t)
    cdef void _join(self, const double[:] position, const double[:] velocity) noexcept nogil
    @cython.locals(place=double[::1])
    cdef bint _is_near(self) noexcept nogil
