cdef class Measurement:
    cdef readonly double time
    cdef readonly object joint_position, joint_velocity, joint_torque, gyro, accelerometer, wrench, q, v, external_force
    cdef readonly bint nonfoot_contact, self_contact
