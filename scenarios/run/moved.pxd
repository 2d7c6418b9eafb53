from surefoot.joints cimport JointCommand
from surefoot.sim.measurement cimport Measurement
from surefoot.wbc.body.model cimport RobotTerms

cdef class Moved:
    cdef readonly object walk, plant
    cdef readonly Measurement measurement
    cdef readonly bint foreign
    cdef object _sensors, _own_truth, _faults, _readings
    cdef RobotTerms _truth
    cdef JointCommand _command
    cdef bint _says_tick
    cdef double _period, _nominal_height

    cpdef sense(self, long long tick, double now)
    cpdef bint lost(self, tick, kind)
    cpdef fallen(self, sample)
    cpdef advance(self, double now)
