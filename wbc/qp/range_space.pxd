cimport cython
cimport libc.math as math
from surefoot.maths cimport algebra, linear
from surefoot.maths.dual_method cimport DualMethod

cdef class Block:
    cdef double[:, :] U, Yw
    cdef double[:] x

cdef class EqualityQp:
    cdef readonly object qp, x
    cdef const double[:, ::1] _H
    cdef const double[::1] _g
    cdef double[::1] _x
    cdef double[:, ::1] U, Yw, _YY
    cdef double[:, :] Y, R
    cdef double[:] _w, _Yw
    cdef double[::1] values, _row_values, _multipliers
    cdef const double[:, ::1] A
    cdef const double[::1] lower, upper
    cdef Py_ssize_t _motion
    cdef list _whole, _apart

    cdef Block _block(self, Py_ssize_t first, Py_ssize_t end)
    @cython.locals(
        n=Py_ssize_t, m=Py_ssize_t, e=Py_ssize_t, i=Py_ssize_t, is_apart=cython.bint, blocks=list, block=Block,
    )
    cpdef double solve(self) except? -2.0
    cpdef double violation(self)
    cdef void evaluate(self)

cdef class InequalityQp(DualMethod):
    cdef EqualityQp _qp
    cdef double _tolerance
    cdef Py_ssize_t _m
    cdef double[:, ::1] _normals, _R
    cdef double[::1] _y, _z, _shares, _equality_r

    cpdef Py_ssize_t solve(self) except? -2
    @cython.locals(i=Py_ssize_t, n=Py_ssize_t, number=Py_ssize_t, is_upper=cython.bint, qp=EqualityQp)
    cdef Py_ssize_t _violated(self) except? -2
    @cython.locals(i=Py_ssize_t, n=Py_ssize_t, sign=double)
    cdef void _turn(self, Py_ssize_t number)
    cdef void _project(self)
    cdef void _move(self, double step)
    cdef void _take(self)
    @cython.locals(k=Py_ssize_t)
    cdef void _leave(self, Py_ssize_t place)
    @cython.locals(k=Py_ssize_t, m=Py_ssize_t)
    cdef double _column(self, double[::1] y, Py_ssize_t count)
    @cython.locals(k=Py_ssize_t, m=Py_ssize_t)
    cdef void _solve_transposed(self, double[::1] c, Py_ssize_t count)
    @cython.locals(k=Py_ssize_t, m=Py_ssize_t)
    cdef void _solve(self, double[::1] c)
    @cython.locals(k=Py_ssize_t, e=Py_ssize_t, i=Py_ssize_t, n=Py_ssize_t, m=Py_ssize_t, is_upper=cython.bint, qp=EqualityQp)
    cdef void _mend(self)
