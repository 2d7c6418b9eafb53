from surefoot.maths cimport algebra, linear

cdef double ACCELERATION_LIMIT

cdef class Checkpoint:
    cdef double[::1] _qpos, _qvel, _last_qpos, _last_qvel
    cdef const double[::1] _qacc

    cpdef void keep(self)
    cpdef void restore(self)
    cpdef bint diverged(self)

cpdef bint is_finite(const double[::1] values)
