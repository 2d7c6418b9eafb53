from surefoot.planner.measured cimport Measured
from surefoot.planner.state cimport WalkState

cdef class View:
    cdef readonly WalkState state
    cdef readonly Measured measured
    cdef readonly object support, local, dcm, window
    cdef readonly double unsure
    cdef readonly object step, balance, bounds
