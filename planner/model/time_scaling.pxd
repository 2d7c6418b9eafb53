cimport cython
from surefoot cimport algebra
from surefoot.planner cimport quintic
from surefoot.planner.quintic cimport quintic6

@cython.locals(k=Py_ssize_t, over=cython.bint)
cpdef void follow(quintic6 course, double length, double begun, const double[:] time, double[:, ::1] told) noexcept

cdef class TimeScaling:
    cdef readonly double sample_time, now
    cdef readonly Py_ssize_t ticks
    cdef readonly double begun, elapsed, way, length
    cdef readonly object coefficients
