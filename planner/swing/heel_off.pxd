cdef class FootRoll:
    cdef readonly object foot
    cdef readonly double start, end, angle, toe
    cdef readonly object scaling
    cdef readonly double told
