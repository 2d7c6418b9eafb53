cdef class ExternalLoad:
    cdef readonly object force, moment
    cdef readonly double mass_scale
