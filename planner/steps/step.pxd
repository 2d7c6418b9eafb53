from surefoot.planner.types cimport Footstep

cdef class Stop:
    cdef readonly double stand, shift, rest

cdef class Step:
    cdef readonly Py_ssize_t number, ordinal
    cdef readonly bint inserted
    cdef readonly object stride, path
    cdef readonly Footstep nominal, place
    cdef readonly object course, swing
    cdef readonly double climb, lift
    cdef readonly object room
    cdef readonly double hardest
    cdef readonly Py_ssize_t support
    cdef readonly object stop
    cdef readonly double lift_off, single_support, double_support
    cdef readonly object toe_off, heel_strike
