from surefoot.readings cimport Readings
from surefoot.joints cimport JointCommand
from surefoot.scenarios.run.controller cimport Controller as Mind
from surefoot.scenarios.run.moved cimport Moved

cdef class WholeBody(Moved):
    cdef readonly Mind mind
    cdef object _recorder, _view, _sensed, _coupled, _somebody
    cdef JointCommand _no_torque
    cdef bint _told

    cpdef control(self, long long tick, double now)
    cpdef record(self, now_ns, sample)
    cpdef draw(self, long long tick, now_ns, plan, sample, bint fallen)
