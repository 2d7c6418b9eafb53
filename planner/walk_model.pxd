cdef class WalkModel:
    cdef readonly object gait, ground, heights, legs, world, outlook, margin, adjustment, leg_offset
    cdef readonly double softening
    cdef readonly object parameters, terrain, half_size
    cdef readonly int count, reach
    cdef readonly bint follows, adapts, times
    cdef readonly double hardest
