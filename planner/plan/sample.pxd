cdef class PlanSample:
    cdef readonly double time
    cdef readonly object point, contacts, swing_foot
