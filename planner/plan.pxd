cdef class WalkPlan:
    cdef readonly double time, sample_time
    cdef readonly object com, com_velocity, com_acceleration, jerk, zmp, zmp_offset, zmp_reference, stiffness, omega, phase, contacts, load_left, support_polygon, inner_polygon, footholds, footsteps, swing, roll, status, balance
