cimport cython
from surefoot.wbc.reference cimport WbcReference
from surefoot.wbc.types cimport FootSensing

cdef Py_ssize_t _NONE

cdef class ContactState:
    cdef readonly (bint, bint) active, felt
    cdef readonly (double, double) force_cap
    cdef readonly (Py_ssize_t, Py_ssize_t) edge
    cdef readonly (bint, bint) landing

cdef class ContactSchedule:
    cdef public double weight
    cdef double _early_progress, _early_cap, _loading_time, _unloading_time, _share_margin, _least, _period
    cdef int _ticks
    cdef int[2] _ticks_felt
    cdef bint[2] _planned, _active, _felt, _awaited
    cdef double[2] _loading
    cdef ContactState _last

    @cython.locals(most=double)
    cpdef ContactState update(self, WbcReference reference, FootSensing sensing)
    cdef int _feel(self, Py_ssize_t k, double force, contact, bint touches) except -1
    @cython.locals(early=cython.bint)
    cdef void _hold(self, Py_ssize_t k, double progress) noexcept
    @cython.locals(cap=double, remaining=double, share=double)
    cdef double _cap(self, Py_ssize_t k, WbcReference reference) noexcept
    @cython.locals(last=ContactState)
    cdef ContactState _contacts(self, (double, double) cap, (Py_ssize_t, Py_ssize_t) edge, (bint, bint) landing)
