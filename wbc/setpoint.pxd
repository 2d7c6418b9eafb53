cimport cython

cdef Py_ssize_t _SIZE

cdef class Setpoint:
    cdef readonly object reference
    cdef object _numbers
    cdef double[::1] _rest
    cdef double[::1] com, com_velocity, com_acceleration, zmp, zmp_offset
    cdef double[::1] swing_position, swing_velocity, swing_acceleration
    cdef double[::1] swing_angular_velocity, swing_angular_acceleration
    cdef double[:, ::1] swing_rotation, ground_normal
    cdef readonly double omega, stiffness, heading, heading_rate
    cdef readonly double load_left, load_right, roll_rate, roll_acceleration
    cdef readonly int swing_foot, rolling_foot
    cdef readonly bint catching

    @cython.locals(rest=double[::1])
    cdef void _name(self) noexcept
