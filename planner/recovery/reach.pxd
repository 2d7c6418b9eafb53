cimport cython
cimport libc.math as math
from surefoot.maths cimport algebra
from surefoot.planner.swing cimport boxes

cdef double PEAK, BRAKING, GAINING
cdef Py_ssize_t BOXES, SHARES

@cython.final
cdef class StepReach:
    cdef object _legs
    cdef bint _crosses, last, adapted
    cdef double radius, hip_width, stride, _across, _lead, _sample_time
    cdef double side, near, clear, double, single, cycle, shortest
    cdef Py_ssize_t boxes
    cdef const double[:] place, at, speed
    cdef const double[::1] _acceleration, _rest, _rest_bend, _moving, _moving_bend, _dearer
    cdef const double[:, ::1] _around
    cdef double[:, ::1] low, high

    cpdef see(self, step)
    cdef bint is_empty(self, Py_ssize_t box) noexcept nogil
    cdef double swing_time(self, double single) noexcept nogil
    @cython.locals(hardest=double)
    cpdef double swung(self, Py_ssize_t axis, double sign, double single) noexcept nogil
    @cython.locals(here=cython.bint, met=cython.bint, best=Py_ssize_t, j=Py_ssize_t, dearest=double, hardest=double)
    cpdef double shortfall(self, double single, double x, double y) noexcept nogil
