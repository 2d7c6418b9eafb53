cimport cython
from surefoot.maths cimport linear

cdef class NominalMotion:
    cdef readonly double sample_time
    cdef readonly Py_ssize_t count
    cdef readonly object com, jerk
    cdef double[:, ::1] c, v, a, u
    cdef double[::1] _lower, _diagonal, _upper

    @cython.locals(k=Py_ssize_t, axis=Py_ssize_t, last=Py_ssize_t)
    cpdef void follow(self, const double[:] position, const double[:, :] zmp, const double[:] stiffness) noexcept
    @cython.locals(axis=Py_ssize_t, last=Py_ssize_t)
    cdef void _begin_system(self, const double[:] position, const double[:, :] zmp) noexcept nogil
    @cython.locals(k=Py_ssize_t, axis=Py_ssize_t, last=Py_ssize_t, c=double[:, ::1], v=double[:, ::1], a=double[:, ::1])
    cdef void _differentiate(self, const double[:, :] zmp, const double[:] stiffness) noexcept nogil
