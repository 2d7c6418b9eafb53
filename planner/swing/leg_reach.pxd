cdef class LegReach:
    cdef readonly double radius, hip_width, near
    cdef readonly object across
    cdef readonly double clear
    cdef readonly object acceleration, sole
    cdef readonly double height, length
    cdef readonly object parameters
