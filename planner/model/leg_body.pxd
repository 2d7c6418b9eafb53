cimport cython
cimport libc.math as math
from surefoot.maths cimport algebra
from surefoot.maths.algebra cimport vector3

cdef double _BEND, _GUESS
cdef Py_ssize_t HIPS, KNEES, ANKLES, FEET, TRUNK, BESIDE, LEFT, RIGHT, MIDDLE

@cython.final
cdef class Body:
    cdef double _half_width, _outward, _lever_beside, _lever_above, _toe, _thigh, _shank, _least_reach
    cdef double _thigh_ahead, _thigh_outward, _shank_ahead, _shank_outward, _thigh_pull, _shank_pull
    cdef double _at_hip, _at_ankle, _trunk_mass, _at_knee, _carried
    cdef vector3 _trunk, _ankle, _to_foot, _own
    cdef bint _rolls_first, _links_beside
    cdef Py_ssize_t _corrections
    cdef Py_ssize_t[:, ::1] _pairs
    cdef readonly object points, bends, rate
    cdef double[:, :, ::1] _points, _bends
    cdef double[:, ::1] _ahead, _rate, _c, _s, _cp, _sp
    cdef double[::1] _masses, _spare

    @cython.locals(k=Py_ssize_t, leg=Py_ssize_t)
    cpdef void turn_legs(self, const double[:, :] heading, const double[:, :] pitch, Py_ssize_t count) noexcept nogil
    @cython.locals(k=Py_ssize_t, leg=Py_ssize_t)
    cpdef void place(self, const double[:, :] com, const double[:, :, :] soles, Py_ssize_t count) noexcept nogil
    @cython.locals(way=vector3)
    @cython.locals(edge=double, ankle=vector3)
    cdef void _place_foot(self, Py_ssize_t leg, Py_ssize_t k, const double[:, :] com, const double[:, :, :] soles) noexcept nogil
    cdef inline vector3 _pitched(self, vector3 way, double ahead, double outward, Py_ssize_t leg, Py_ssize_t k) noexcept nogil
    @cython.locals(k=Py_ssize_t, leg=Py_ssize_t)
    cdef void _place_legs(self, Py_ssize_t count) noexcept nogil
    @cython.locals(k=Py_ssize_t, middle=vector3, hip=vector3, ankle=vector3)
    cdef void _place_hip(self, Py_ssize_t leg, Py_ssize_t count) noexcept nogil
    @cython.locals(k=Py_ssize_t, ahead=vector3, hip=vector3, ankle=vector3)
    cdef void _bend_knee(self, Py_ssize_t leg, Py_ssize_t count) noexcept nogil
    @cython.locals(k=Py_ssize_t, knee=vector3, ankle=vector3)
    cdef void _turn_ahead(self, Py_ssize_t leg, Py_ssize_t count) noexcept nogil
    @cython.locals(k=Py_ssize_t, own=vector3, middle=vector3, one=vector3, other=vector3)
    cdef void _correct(self, Py_ssize_t count) noexcept nogil
    @cython.locals(leg=Py_ssize_t, middle=vector3, trunk=vector3)
    cdef void _settle(self, Py_ssize_t k) noexcept nogil
    @cython.locals(hip=vector3, knee=vector3, ankle=vector3)
    cdef void _place_beside(self, Py_ssize_t leg, Py_ssize_t k) noexcept nogil
    cdef inline vector3 _point(self, Py_ssize_t point, Py_ssize_t k) noexcept nogil
    cdef inline void _put(self, Py_ssize_t point, Py_ssize_t k, vector3 at) noexcept nogil
    @cython.locals(point=Py_ssize_t, axis=Py_ssize_t, k=Py_ssize_t, pair=Py_ssize_t, last=Py_ssize_t, i=Py_ssize_t, j=Py_ssize_t, y=Py_ssize_t, z=Py_ssize_t)
    cpdef void turn_momentum(self, Py_ssize_t count, double sample_time, Py_ssize_t axes) noexcept nogil
    @cython.locals(k=Py_ssize_t, end=Py_ssize_t)
    cdef void _bend(self, Py_ssize_t point, Py_ssize_t axis, Py_ssize_t last) noexcept nogil

@cython.locals(k=Py_ssize_t)
cdef void turn(const double[:] angle, Py_ssize_t count, double[::1] cosine, double[::1] sine) noexcept nogil
cdef inline vector3 beside_of(vector3 upper, vector3 lower, double ahead, double outward, double c, double s) noexcept nogil
cdef inline vector3 bent(vector3 hip, vector3 ankle, vector3 ahead, double a, double b, double least) noexcept nogil
