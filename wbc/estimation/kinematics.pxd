cimport cython
from surefoot.maths cimport algebra, linear
from surefoot.maths.algebra cimport vector3
from surefoot.engines.mimic cimport JointColumns

@cython.final
cdef class Sole:
    cdef object _data
    cdef const double[:, :] _joint_rotation
    cdef const double[:] _joint_position
    cdef double[:, ::1] _placed_rotation
    cdef vector3 _placed_position
    cdef double[:, ::1] rotation
    cdef vector3 position

    cdef void place(self) noexcept

@cython.final
cdef class SensedBody:
    cdef readonly object model, chain, position, rotation, ahead, jacobian, leaning
    cdef readonly double mass
    cdef readonly bint behind
    cdef object _data, _q, _v
    cdef JointColumns _columns
    cdef Sole _left, _right
    cdef Py_ssize_t _parent
    cdef const Py_ssize_t[::1] _chain
    cdef double[:, ::1] _supporting
    cdef const double[:, :] _joint_rotation
    cdef const double[:] _joint_position
    cdef const double[::1, :] _joint_jacobian, _com_jacobian
    cdef const double[:] _com
    cdef double[:, ::1] _mount_rotation, _turn, _mounted, _imu_rotation
    cdef vector3 _mount_position, _imu_position
    cdef double[::1] _angles, _speeds, _ahead
    cdef double[:, ::1] carried
    cdef vector3 lever, turning, moving
    cdef double[:, ::1] _position
    cdef double[:, :, ::1] _rotation, _jacobian

    @cython.locals(m=Py_ssize_t, c=Py_ssize_t, turn=vector3)
    cpdef update(self, const double[:] joints, attitude, const double[:] offsets=*)
    cdef void _place_imu(self, vector3 turn) noexcept
    cdef void _place_sole(self, Py_ssize_t k, Sole sole) noexcept
    @cython.locals(k=Py_ssize_t)
    cpdef offset_jacobians(self)
    @cython.locals(at=vector3, c=Py_ssize_t, j=Py_ssize_t, carries=double, moved=vector3, turned=vector3)
    cdef void _by_joints(self, Py_ssize_t k) noexcept
    @cython.locals(J=double[:, ::1], m=Py_ssize_t, x=double, y=double, z=double)
    cdef void _by_mount(self, Py_ssize_t k) noexcept
    cpdef vector3 in_base(self, Py_ssize_t k) noexcept
    cdef vector3 _to_imu(self, vector3 a) noexcept
    @cython.locals(c=Py_ssize_t, along=vector3)
    cpdef vector3 moved_by(self, Py_ssize_t joint, vector3 at) noexcept
    @cython.locals(c=Py_ssize_t)
    cdef vector3 _axis(self, Py_ssize_t joint) noexcept
    cpdef vector3 turned_to_imu(self, vector3 turn) noexcept
    cpdef place_com(self)
    @cython.locals(arm=vector3, spin=vector3)
    cdef carry(self, const double[:] q, const double[:] v, vector3 turn)
    cpdef vector3 com_from(self, vector3 at) noexcept
    cpdef vector3 com_by(self, Py_ssize_t joint) noexcept
    cpdef double carries(self, Py_ssize_t joint, Py_ssize_t k) noexcept
    @cython.locals(i=Py_ssize_t, j=Py_ssize_t)
    cpdef void to_world(self, const double[:, :] R, double[:, :] out) noexcept
