cimport cython
cimport libc.math as math
from surefoot.maths cimport algebra, linear
from surefoot.maths.algebra cimport vector3

cdef class ImuMotion:
    cdef readonly double[:, ::1] rotation
    cdef readonly vector3 velocity, angular_velocity

cdef class Link:
    cdef Py_ssize_t joint
    cdef bint beside
    cdef double ratio, offset
    cdef double[:, ::1] rotation, lever, twist, square
    cdef vector3 axis, point

    @cython.locals(i=Py_ssize_t, j=Py_ssize_t)
    cdef void turn(self, double angle, double[:, ::1] out) noexcept nogil

cdef class ImuChain:
    cdef list _links
    cdef double[:, ::1] _mount, _lever, _R, _E, _turn, _product

    @cython.locals(at=ImuMotion, link=Link, angle=double)
    cpdef ImuMotion motion(self, const double[:] q, const double[:] v)
    cdef void _pass(self, Link link, double angle, double speed, ImuMotion at) noexcept
    @cython.locals(i=Py_ssize_t, j=Py_ssize_t)
    cdef vector3 _moved_beside(self, Link link, vector3 rate) noexcept
