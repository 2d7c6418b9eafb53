cdef class Stop:
    cdef readonly double stand, shift, rest

cdef class Step:
    cdef readonly Py_ssize_t number, ordinal
    cdef readonly bint inserted
    cdef readonly object stride, path, nominal, place, course, swing
    cdef readonly double climb, lift
    cdef readonly object room
    cdef readonly double hardest
    cdef readonly Py_ssize_t support
    cdef readonly object stop
    cdef readonly double lift_off, single_support, double_support
    cdef readonly object roll
