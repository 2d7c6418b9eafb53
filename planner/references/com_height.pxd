cimport cython
cimport libc.math as math
from surefoot.maths.algebra cimport vector3
from surefoot.planner.steps.phases cimport PhaseSamples

cdef Py_ssize_t _DOUBLE, _SINGLE
cdef double _PI, GRAVITY

@cython.locals(
    elapsed=double[::1], length=double[::1], fraction=double[::1], rate=double[::1], kind=Py_ssize_t[::1],
    index=Py_ssize_t[::1], t=double, k=Py_ssize_t, at=Py_ssize_t, swings=cython.bint, rise=vector3, bump=vector3,
    low=double, change=double, share=double, pace=double, apex=double,
)
cdef void _fill(PhaseSamples samples, vector3 apexes, double standing, const double[:] levels, bint early, double[:, ::1] height)
@cython.locals(level=double)
cdef double _level(const double[:] levels, Py_ssize_t at, bint early) noexcept nogil
@cython.locals(k=Py_ssize_t)
cdef void _in_time(const double[:] rate, const double[:] bend, double[:, ::1] height) noexcept
cdef vector3 quintic_rise(double s, double rate) noexcept nogil
cdef vector3 sine_cubed(double apex, double elapsed, double length, double sample_time) noexcept nogil
@cython.locals(k=Py_ssize_t)
cdef void _stiffen(const double[:, :] height, const double[:] ground, double pressing, double over, double[::1] stiffness) noexcept

cdef class HeightPreview:
    cdef readonly object height, stiffness
