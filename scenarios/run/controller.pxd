from surefoot.joints cimport JointCommand
from surefoot.readings cimport Reading, Readings
from surefoot.scenarios.run.sensed cimport Senses
from surefoot.wbc.estimation.estimate cimport Estimate
from surefoot.wbc.types cimport WbcReport

cdef class Controller:
    cdef readonly object walk, body, whole_body, planning, posture, state, report, terms, wrench, sample, spent
    cdef readonly Senses senses
    cdef readonly Estimate estimate
    cdef object _parts, _leg, _faults, _output, _giving_way, _landed, _arriving, _load, _landing, _torques, _normals
    cdef JointCommand _command
    cdef double _period, _next, _toe, _heel, _begin, _now
    cdef bint _estimates, _stands

    cdef _stand(self, q)
    cpdef step(self, readings, command=*, driven_joints=*)
    cdef _decide(self, WbcReport report)
    cdef _observe(self, readings, double now)
    cpdef _touching(self)
    cdef _drive(self, driven, JointCommand command)
    cdef _inferred(self, readings, state, double passed)
    cdef _lasting(self)
