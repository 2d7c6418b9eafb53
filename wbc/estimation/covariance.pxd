cimport cython
from surefoot.maths cimport algebra, linear
from surefoot.wbc.estimation cimport stand
from surefoot.wbc.estimation.stand cimport Stand

cdef Py_ssize_t COLUMNS, POSE, MOST

@cython.final
cdef class Covariance:
    cdef readonly object P, gain, weights
    cdef Stand _state
    cdef Py_ssize_t _encoders
    cdef double _gyro, _speed, _gyro_walk, _force_walk, _encoder, _place, _turning
    cdef double _creep, _sinking, _rocking, _light, _unsure, _free
    cdef bint _leaning
    cdef double[:, ::1] _P, _gain, _weights
    cdef double[:, ::1] _fall, _B, _BR, _BB, _before, _turned, _fallen, _pushed, _RJ, _PH, _HP, _apart, _S, _U
    cdef double[::1] _noise
    cdef Py_ssize_t[::1] _at, _from

    cpdef void advance(self, double t, double[:, :] x) noexcept nogil
    @cython.locals(i=Py_ssize_t)
    cdef void _see_turns(self) noexcept nogil
    @cython.locals(i=Py_ssize_t)
    cdef void spread(self, double t) noexcept nogil
    @cython.locals(i=Py_ssize_t, way=double)
    cdef void add_standing(self, Py_ssize_t k, double t, double load) noexcept nogil
    cdef void add_springs(self, Py_ssize_t k, algebra.vector3 turned, double risen) noexcept nogil
    cdef void add_turning(self, Py_ssize_t k, double t, bint rolls) noexcept nogil
    @cython.locals(i=Py_ssize_t, j=Py_ssize_t)
    cdef void _add_turn(self, Py_ssize_t k, double t, Py_ssize_t axis) noexcept nogil
    @cython.locals(i=Py_ssize_t, HP=double[:, :])
    cdef bint weigh(self, const Py_ssize_t[:] feet, const double[:, :, :] J, double ticks) noexcept nogil
    @cython.locals(i=Py_ssize_t, RJ=double[:, :])
    cdef void _look(self, Py_ssize_t first, Py_ssize_t k, const double[:, :] J) noexcept nogil
    @cython.locals(RJ=double[:, :], at=Py_ssize_t[::1], from_=Py_ssize_t[::1])
    cdef void _project(self, Py_ssize_t rows) noexcept nogil
    @cython.locals(r=Py_ssize_t)
    cdef bint _factor(self, Py_ssize_t rows, double ticks) noexcept nogil
