cimport cython
from surefoot.maths cimport algebra
from surefoot.maths.algebra cimport vector3
from surefoot.models cimport convert
from surefoot.sim.measurement cimport Measurement

cdef double ROUND_OFF

cdef class Sole:
    cdef Py_ssize_t foot
    cdef const double[::1] position
    cdef const double[:, ::1] rotation
    cdef double[::1] wrench

    cdef void feel(self, const double[:, ::1] external, vector3 com) noexcept nogil

cdef class SensorReader:
    cdef public object model
    cdef object _data, _pushes, _coordinates, _touch
    cdef bint _couples
    cdef tuple _views
    cdef list _soles
    cdef const double[::1] _qpos, _qvel, _joint_force, _acceleration, _gravity, _com, _mean
    cdef const double[:, ::1] _base, _body_com, _external
    cdef double[:, ::1] _contact
    cdef double[::1] _q, _v, _torque, _accelerometer, _push

    cdef void _allocate(self, Py_ssize_t nq, Py_ssize_t nv, wrench)
    cpdef Measurement read(self, double time)
    @cython.locals(sole=Sole)
    cdef void _read(self, const double[:, ::1] external)
    @cython.locals(force=double[::1])
    cdef _gather(self)
    cdef void _without_pushes(self)
    @cython.locals(lever=vector3, torque=vector3, rest=vector3)
    cdef void _take_off(self, Py_ssize_t body, vector3 force) noexcept

cdef double _largest(vector3 a, vector3 b) noexcept nogil
