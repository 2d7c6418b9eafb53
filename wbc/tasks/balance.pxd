cimport cython
cimport libc.math as math
from surefoot.maths cimport algebra, polygon
from surefoot.maths.algebra cimport vector3
from surefoot.wbc.reference cimport WbcReference

cdef class SupportRegion:
    cdef double[:, ::1] _corners, _points, _vertices, _edges
    cdef Py_ssize_t _count

    @cython.locals(count=Py_ssize_t, k=Py_ssize_t, i=Py_ssize_t, j=Py_ssize_t, x=double, y=double, rolls=cython.bint)
    cpdef rebuild(self, const double[:, :] positions, const double[:, :, :] rotations, (bint, bint) active, (Py_ssize_t, Py_ssize_t) edge=*)
    @cython.locals(edge=double[::1])
    cdef void _write_edge(self, Py_ssize_t start, Py_ssize_t end) noexcept nogil
    @cython.locals(edge=double[::1], i=Py_ssize_t, share=double)
    cpdef (double, double) project(self, double x, double y, double beyond=*) noexcept
    @cython.locals(edge=double[::1], i=Py_ssize_t)
    cdef bint _holds(self, double x, double y) noexcept nogil

cdef class BalanceLaw:
    cdef SupportRegion _region
    cdef double _k, _beyond, _k_z, _d_z

    @cython.locals(ref=WbcReference)
    cpdef vector3 acceleration(self, WbcReference reference, const double[:] c, const double[:] c_dot) noexcept
