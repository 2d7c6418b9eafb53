from surefoot.readings cimport Readings
from surefoot.joints cimport JointCommand
from surefoot.scenarios.run.controller cimport Controller as Mind

cdef class WholeBody:
    cdef readonly Mind mind
    cdef readonly object plant, measurement
    cdef object _sensors, _recorder, _view, _sensed, _coupled, _own_truth, _faults, _somebody, _readings, _truth
    cdef JointCommand _no_torque, _command
    cdef bint _foreign, _says_tick, _told
    cdef double _period, _nominal_height

    cpdef sense(self, long long tick, double now)
    cpdef control(self, long long tick, double now)
    cpdef record(self, now_ns, sample)
    cpdef fallen(self, sample)
    cpdef draw(self, long long tick, now_ns, plan, sample, bint fallen)
    cpdef advance(self, double now)
