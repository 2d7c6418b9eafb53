cdef class Servo:
    cdef readonly object position, velocity, stiffness, damping

cdef class JointCommand:
    cdef readonly object torque
    cdef readonly Servo servo
