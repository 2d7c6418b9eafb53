cimport cython
from surefoot.maths cimport algebra

cdef Py_ssize_t _DOUBLE
cdef double CLOCK_ROUNDING

cdef class Phase:
    cdef readonly object kind
    cdef readonly double start, samples
    cdef readonly Py_ssize_t step
    cdef readonly object stance
    cdef readonly Py_ssize_t support
    cdef readonly double rest
    cdef readonly tuple rolls
    cdef readonly bint starts

cdef class PhaseTable:
    cdef readonly tuple phases
    cdef readonly object kind, start, length, rest, support, contacts

cdef object _LEFT, _RIGHT

@cython.locals(k=Py_ssize_t, phase=Phase)
cdef void _tabulate(
    tuple phases, Py_ssize_t[::1] kind, Py_ssize_t[::1] support, double[::1] start, double[::1] length,
    double[::1] rest, unsigned char[:, ::1] contacts,
)

cdef class PhaseSamples:
    cdef readonly object phases, which, kind, clock, rate, elapsed, length, index, fraction, fraction_rate, contacts
    cdef readonly double sample_time
    cdef readonly Py_ssize_t first

    @cython.locals(here=Py_ssize_t, last=Py_ssize_t, k=Py_ssize_t)
    cdef void _look_up(self, const double[:] start, const double[:] clock, Py_ssize_t[::1] which)
    @cython.locals(
        elapsed=double[::1], fraction=double[::1], fraction_rate=double[::1], lengths=double[::1],
        kinds=Py_ssize_t[::1], index=Py_ssize_t[::1], k=Py_ssize_t, phase=Py_ssize_t, ramp=double, gone=double,
    )
    cdef void _measure(
        self, const Py_ssize_t[::1] which, const double[:] clock, const double[:] start, const double[:] length,
        const double[:] rest, const Py_ssize_t[:] kind, const Py_ssize_t[:] support,
    )
