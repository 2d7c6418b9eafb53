cimport cython
from surefoot.maths cimport algebra, linear
from surefoot.maths.algebra cimport vector3
from surefoot.wbc.estimation.kinematics cimport SensedBody
from surefoot.wbc.estimation.stand cimport Stand

@cython.final
cdef class FloatingBase:
    cdef readonly object q, v
    cdef Stand _stand
    cdef SensedBody _body
    cdef const Py_ssize_t[::1] _chain
    cdef const double[::1] _rate
    cdef double[:, ::1] _R, _turn, _half
    cdef double[::1] _q, _v
    cdef double _farthest, _fastest

    cpdef state(self, const double[:] position, const double[:] velocity, const double[:] gained, double late)
    cpdef seen(self, const double[:] position, const double[:] velocity, vector3 v, vector3 rate)
    @cython.locals(s=Stand, body=SensedBody, m=Py_ssize_t, i=Py_ssize_t, own=vector3, spin=vector3, speed=vector3)
    cdef _place(self, const double[:] position, const double[:] velocity, vector3 v, vector3 rate)
    cdef void _go_on(self, const double[:] gained, double late) noexcept nogil
    @cython.locals(place=double[::1])
    cdef bint _is_near(self) noexcept nogil
