cdef class Reading:
    cdef readonly object values
    cdef readonly double age
    cdef readonly bint fresh

cdef class Readings:
    cdef readonly double time
    cdef readonly Reading joint_position, joint_velocity, joint_torque
    cdef readonly Reading angular_velocity, mean_angular_velocity, specific_force, wrench
