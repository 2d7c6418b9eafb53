cimport cython
from surefoot.maths cimport linear

cdef class SwingTrajectory:
    cdef readonly object foot
    cdef readonly double start_time, glide_end, apex_time, touchdown_time
    cdef readonly object target
    cdef readonly double clearance
    cdef readonly object search, level
    cdef readonly double rise_start
    cdef readonly object rise
    cdef readonly double fall_start
    cdef readonly object fall
    cdef readonly double bend_time
    cdef readonly object onward
    cdef readonly double aim, lifting

cdef class SwingCourse:
    cdef readonly double apex, glide_start, glide_end, height, braking, lead, sinking
