from surefoot.readings cimport Readings
from surefoot.joints cimport JointCommand
from surefoot.scenarios.run.moved cimport Moved

cdef class Seated(Moved):
    cdef readonly object mind
    cdef object _guard, _recorder, _view, _sensed, _coupled, _felt, _waiting, _rate, _twist, _reported
    cdef bint _heard
    cdef JointCommand _no_torque

    cpdef control(self, long long tick, double now)
    cdef _due(self, double now)
    cdef _torque(self)
    cpdef record(self, now_ns, sample)
    cpdef draw(self, long long tick, now_ns, plan, sample, bint fallen)
