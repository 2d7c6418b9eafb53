from surefoot.planner.types cimport CentroidalState

cdef class PlannerState:
    cdef readonly CentroidalState measured
    cdef readonly object measured_zmp
    cdef readonly CentroidalState given
    cdef readonly object acceleration, innovation

cdef class WalkRecorder:
    cdef object _reference, _state, _plan, _footsteps, _footstep, _command, _timing, _process, _writer, _support
    cdef long long _begun, _looked
    cdef bytes _polygon
    cdef bint _rolls

    cpdef reference(self, time_ns, plan, sample)
    cpdef timing(self, time_ns, timing)
