from surefoot.joints cimport JointCommand
from surefoot.sim.checkpoint cimport Checkpoint
from surefoot.sim.sensors cimport SensorReader

cdef class World:
    cdef readonly object description, data, physics_rate
    cdef readonly long long tick
    cdef object _mjcf, _model, _drives, _coordinates, _pushes, _ctrl, _qpos, _qvel, _xfrc, _torque
    cdef SensorReader _sensors
    cdef Checkpoint _sound
    cdef bint _is_shared

    cpdef measure(self)
    cpdef advance(self, torque, long long steps)
    cpdef act(self, JointCommand command, double period)
    cdef _diverge(self)
