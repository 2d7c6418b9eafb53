cimport cython
from surefoot.maths.algebra cimport vector3
from surefoot.planner.geometry cimport quintic
from surefoot.planner.geometry.quintic cimport quintic6

@cython.locals(k=Py_ssize_t, way=double, rate=double, bend=double)
cpdef void follow(quintic6 course, double length, double begun, const double[:] time, double[:, ::1] out) noexcept

@cython.locals(t=double)
cpdef vector3 followed(quintic6 course, double length, double time) noexcept nogil

cdef class TimeScaling:
    cdef readonly double sample_time, now
    cdef readonly Py_ssize_t ticks
    cdef readonly double begun, elapsed, way, length
    cdef readonly object coefficients
