cimport cython
from surefoot.planner.plan.plan cimport WalkPlan
from surefoot.planner.plan.sample cimport PlanSample
from surefoot.planner.swing.heel_off cimport FootRoll
from surefoot.planner.types cimport CentroidalState, PhaseInfo

cdef class PlannerState:
    cdef readonly CentroidalState measured
    cdef readonly object measured_zmp
    cdef readonly CentroidalState given
    cdef readonly object acceleration, innovation

cdef class RunRecorder:
    cdef object _footstep, _command, _timing, _process, _writer
    cdef long long _begun, _looked

    cpdef timing(self, time_ns, timing)

cdef class WalkRecorder(RunRecorder):
    cdef object _reference, _state, _plan, _footsteps, _support
    cdef bytes _polygon
    cdef bint _rolls

    @cython.locals(phase=PhaseInfo, roll=FootRoll)
    cpdef reference(self, time_ns, WalkPlan plan, PlanSample sample)
