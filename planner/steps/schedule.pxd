cdef class Schedule:
    cdef readonly object gait, ground, source, steps
    cdef readonly bint stands
    cdef readonly object shift
    cdef readonly double begin
    cdef readonly object nominal_steps, phases
