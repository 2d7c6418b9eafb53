cimport cython
from surefoot.maths cimport algebra, linear
from surefoot.maths.algebra cimport vector3
from surefoot.wbc.estimation cimport stand
from surefoot.wbc.estimation.estimate cimport Deviation
from surefoot.wbc.estimation.kinematics cimport SensedBody

@cython.final
cdef class Doubt:
    cdef readonly vector3 lever
    cdef SensedBody _body
    cdef object _turning, _variances
    cdef double _rate_noise, _encoder_offset, _weight
    cdef Py_ssize_t _joints
    cdef const Py_ssize_t[::1] _chain
    cdef const double[:, ::1] _R, _columns, _P, _position
    cdef const double[:, :, ::1] _jacobian
    cdef double[:, ::1] _to_world, _rows
    cdef double[::1] _variance
    cdef vector3 _by_others, _by_rates

    @cython.locals(deviation=object, up=double)
    cpdef Deviation deviation(self, contact, double gyro)
    @cython.locals(a=Py_ssize_t, found=double, arm=vector3, reach=vector3)
    cpdef look(self, Py_ssize_t stance, double gyro)
    @cython.locals(body=SensedBody, at=vector3, c=Py_ssize_t, j=Py_ssize_t, moved=vector3, own=vector3, by=vector3, rate=vector3)
    cdef void _of_joints(self, Py_ssize_t stance) noexcept
    @cython.locals(x=double, y=double, z=double, i=Py_ssize_t, turned=vector3)
    cdef void _of_com(self, vector3 arm) noexcept
    @cython.locals(k=Py_ssize_t, foot=vector3, x=double, y=double, _=double, c=Py_ssize_t, by=vector3, i=Py_ssize_t)
    cdef void _of_heights(self) noexcept
    @cython.locals(mount=Py_ssize_t)
    cdef void _of_tilt(self) noexcept
    @cython.locals(v=Py_ssize_t, far=double, squares=vector3, beside=vector3, offsets=vector3, rates=vector3, turns=vector3, speed=vector3, place=vector3)
    cdef void _add_noise(self, vector3 reach, double gyro) noexcept
