cdef class Deviation:
    cdef readonly object com, com_velocity, tilt, sole_height
    cdef readonly double step_height, force, moment

cdef class Estimate:
    cdef readonly object state, wrench, contact
    cdef readonly Deviation deviation
    cdef readonly object channels
    cdef readonly double wrench_age

cdef class Planned:
    cdef readonly object acceleration, torque, contact
    cdef readonly (Py_ssize_t, Py_ssize_t) edge
