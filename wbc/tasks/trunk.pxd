cimport cython
cimport libc.math as math
from surefoot.maths cimport algebra, linear
from surefoot.maths.algebra cimport vector3
from surefoot.wbc.body.model cimport RobotTerms
from surefoot.wbc.reference cimport WbcReference
from surefoot.wbc.tasks cimport law
from surefoot.wbc.tasks.law cimport TaskLaw

cdef class HipStops:
    cdef readonly object hips
    cdef double _softened
    cdef const long long[::1] _columns
    cdef const double[::1] _sign, _lower, _upper

    @cython.locals(
        i=Py_ssize_t, column=Py_ssize_t, sign=double, lower=double, upper=double, above=cython.bint, excess=double,
        roll=double, rate=double, turning=double
    )
    cpdef (double, double) roll(self, RobotTerms terms) noexcept
    cdef double _taken(self, double excess) noexcept nogil
    cdef double _slope(self, double excess) noexcept nogil

cdef class Upright(TaskLaw):
    cdef public object weight, catching_weight
    cdef double _k, _d
    cdef double[:, ::1] _R_d

    cdef vector3 turn(
        self, WbcReference reference, vector3 yaw, vector3 roll, const double[:, :] R, const double[:] velocity
    ) noexcept

cdef class Pelvis(Upright):
    cdef HipStops _stops

    @cython.locals(i=Py_ssize_t, roll=double, rate=double, turned=vector3)
    cdef void put(
        self, RobotTerms terms, WbcReference reference, const double[::1] scale, double[:, ::1] rows, double[::1] target
    ) noexcept

cdef class Torso(Upright):
    @cython.locals(still=vector3, wanted=vector3)
    cdef void put(
        self, RobotTerms terms, WbcReference reference, const double[::1] scale, double[:, ::1] rows, double[::1] target
    ) noexcept
