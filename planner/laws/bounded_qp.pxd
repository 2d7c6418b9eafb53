cimport cython
cimport libc.math as math
from surefoot.maths cimport linear
from surefoot.maths.dual_method cimport DualMethod

cdef class BoundedQp(DualMethod):
    cdef Py_ssize_t _n, _rows
    cdef double _tolerance
    cdef readonly bint is_definite
    cdef double[:, ::1] _U, _U_inverse, _J, _R
    cdef double[::1] _share, _values, _x, _normal, _d, _z
    cdef const double[:, ::1] _G
    cdef const double[::1] _h, _lower, _upper

    @cython.locals(i=Py_ssize_t)
    cpdef factorise(self, const double[:, ::1] P, const double[:, ::1] G)
    cpdef minimised(self, const double[::1] q, const double[::1] h, const double[::1] lower, const double[::1] upper)
    @cython.locals(number=Py_ssize_t)
    cdef Py_ssize_t _violated(self) except? -2
    @cython.locals(i=Py_ssize_t, number=Py_ssize_t, is_lower=cython.bint, worst=double)
    cdef Py_ssize_t _violated_bound(self) noexcept
    @cython.locals(i=Py_ssize_t, row=Py_ssize_t, worst=double)
    cdef Py_ssize_t _violated_row(self)
    @cython.locals(k=Py_ssize_t, active=Py_ssize_t)
    cdef void _project(self)
    cdef void _move(self, double step)
    @cython.locals(i=Py_ssize_t, k=Py_ssize_t, last=Py_ssize_t)
    cdef void _take(self)
    @cython.locals(i=Py_ssize_t, k=Py_ssize_t, active=Py_ssize_t, a=double, b=double)
    cdef void _leave(self, Py_ssize_t place)
