from surefoot.planner.types cimport CentroidalState, FeetState

cdef class Measured:
    cdef readonly CentroidalState body
    cdef readonly FeetState feet
