cimport cython
from surefoot.maths cimport algebra, linear
from surefoot.maths.algebra cimport vector3

cdef class Frame:
    cdef double[:, :] rotation
    cdef double[:] position, velocity, bias
    cdef double[:, :] jacobian
    cdef double[:, :] _joint_rotation, _joint_jacobian, _fixed_rotation
    cdef double[:] _joint_position, _joint_velocity, _joint_acceleration, _fixed_position
    cdef const long long[::1] _columns

    cdef void place(self) noexcept nogil
    cdef void update(self) noexcept nogil
    @cython.locals(p=vector3)
    cdef void shift(self, double[:, :] R, double[:] origin) noexcept nogil

cdef vector3 _linear(const double[:] motion) noexcept nogil
cdef vector3 _angular(const double[:] motion) noexcept nogil
cdef void _put(double[:] motion, vector3 linear, vector3 angular) noexcept nogil
