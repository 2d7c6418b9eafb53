cimport cython
from surefoot.maths.algebra cimport vector3

@cython.locals(w=double, tilt=double)
cpdef vector3 bump(double s) noexcept nogil

cdef class FootRoll:
    cdef readonly object foot
    cdef readonly double start, end, angle, pivot
    cdef readonly object scaling
    cdef readonly double shown
