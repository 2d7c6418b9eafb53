cimport cython

cdef class AccelerationBounds:
    cdef readonly double reach_time, position_rate, velocity_rate
    cdef readonly object positions, velocities
    cdef double[:, ::1] _positions, _velocities

    @cython.locals(
        j=Py_ssize_t, lowest=double, highest=double, slowest=double, fastest=double, reach=double
    )
    cpdef void write(
        self, const double[:] position, const double[:] velocity, double[:] lower, double[:] upper
    ) noexcept
