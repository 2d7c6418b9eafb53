cimport cython
cimport libc.math as math
from surefoot.maths cimport algebra, linear
from surefoot.maths.algebra cimport vector3

cdef class Separation:
    cdef object _model, _data, _geometry, _parameters, _shapes, _written, _joints
    cdef list _results, _pairs
    cdef double _attention
    cdef Py_ssize_t _filled
    cdef readonly bint is_clear

    cpdef write(self, data, v, rows, lower, double unbounded)
    cpdef look_into(self, data)
    @cython.locals(k=Py_ssize_t, pair=Pair)
    cpdef list due(self)
    @cython.locals(k=Py_ssize_t, pair=Pair, distance=double)
    cdef list _near(self, list due)
    @cython.locals(pair=Pair, k=Py_ssize_t, slot=Py_ssize_t)
    cdef _fill(self, list near, v, rows, lower, double unbounded)

cdef class Pair:
    cdef public double distance
    cdef double _radius
    cdef vector3 _centre, _p
    cdef double[::1] _p_1, _p_2
    cdef double[::1, :] _R_1, _R_2
    cdef double[:, :] _jacobian
    cdef double[:, ::1] _R
    cdef const long long[::1] _columns_1, _columns_2

    @cython.locals(moved=vector3, now=vector3, turned=double, most=double)
    cpdef bint is_due(self, double attention) noexcept
    cdef vector3 _seen(self) noexcept nogil
    cdef double _lever(self, Py_ssize_t i) noexcept nogil
    cpdef double rate(
        self, const double[:] direction, const double[:] first, const double[:] second, const double[:] v,
        double[:, :] rows, Py_ssize_t slot
    ) noexcept
    @cython.locals(i=Py_ssize_t, j=Py_ssize_t, along=double, J=double[:, :])
    cdef void _add_point(
        self, double sign, vector3 n, vector3 point, const long long[::1] columns, double[:, :] rows, Py_ssize_t slot
    ) noexcept nogil
