cimport cython
from surefoot.maths cimport algebra
from surefoot.readings cimport Reading

cdef double CARRIES, UNLIKELY, FIRM_EDGE

@cython.final
cdef class SoleContact:
    cdef readonly object wrench, tare, tared
    cdef readonly list felt, firm
    cdef readonly tuple deviation
    cdef readonly double threshold, weight, age
    cdef object _parameters, _wrenches
    cdef double _period, _half_length, _half_width, _share, _late, _slow_share, _tare_share, _lasting, _bias, _settled
    cdef double _released, _tared_after, _anchored, _edge, _tare_time, _tare_height
    cdef Py_ssize_t _ticks
    cdef bint _begun
    cdef double[:, ::1] _filtered, _tare, _wrench
    cdef double[::1] _slow, _tared
    cdef Py_ssize_t[::1] _count

    cpdef update(self, Reading reading, still, const double[:] above, (int, int) edge=*)
    @cython.locals(k=Py_ssize_t, i=Py_ssize_t)
    cdef void _filter(self, const double[:, :] reading, double share) noexcept
    cdef double _force(self, Py_ssize_t k) noexcept
    @cython.locals(more=double, force=double, touches=cython.bint)
    cdef void _feel(self, Py_ssize_t k)
    @cython.locals(load=double, reach=double, pitch=double, roll=double)
    cdef bint _settled_on(self, Py_ssize_t k, int edge)
    @cython.locals(left=double, i=Py_ssize_t)
    cdef void _tare_foot(self, Py_ssize_t k, double above)
