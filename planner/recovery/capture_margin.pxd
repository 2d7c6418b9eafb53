cimport cython
cimport libc.math as math
from surefoot.maths cimport algebra
from surefoot.planner.recovery.reach cimport StepReach

cdef Py_ssize_t EDGES

cdef class CaptureMargin:
    cdef readonly double cycle
    cdef bint _timing
    cdef double _least_double, _least_single, _longer
    cdef const double[::1] _shares, _half, _apart, _middle
    cdef double _omega
    cdef const double[:] _com, _dcm
    cdef double[::1] _margins, _ahead, _spanned, _near, _over
    cdef double[:, ::1] _captured
    cdef StepReach _reach

    cdef _make_room(self, Py_ssize_t steps)
    @cython.locals(m=Py_ssize_t, e=Py_ssize_t)
    cdef void _land(self, double growth, double side, Py_ssize_t count) noexcept nogil
    cpdef margins(self, const double[:] com, const double[:] dcm, double omega, step, Py_ssize_t steps, bint fixed=*)
    @cython.locals(step=StepReach, m=Py_ssize_t, k=Py_ssize_t, shorter=Py_ssize_t, chosen=cython.bint, double=double)
    cdef void _find(self, Py_ssize_t steps, bint fixed) noexcept
    @cython.locals(m=Py_ssize_t, e=Py_ssize_t, box=Py_ssize_t, least=double, margin=double)
    cdef void _catch(self, double double, double single, Py_ssize_t steps, bint fixed) noexcept
    @cython.locals(step=StepReach, e=Py_ssize_t, axis=Py_ssize_t, place=double, edge=double)
    cdef void _limit(self, Py_ssize_t box, double single, double grown, double doubled, bint fixed) noexcept
