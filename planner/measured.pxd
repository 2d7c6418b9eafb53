cdef class Measured:
    cdef readonly object body, feet
