cimport cython
from libc.stdint cimport int64_t
from surefoot.maths cimport algebra, linear
from surefoot.maths.algebra cimport vector3
from surefoot.planner.model cimport dcm
from surefoot.planner.model.nominal cimport NominalMotion

cdef Py_ssize_t SHIFTS, EXTRA

cdef class FootstepQps:
    cdef object _parameters
    cdef readonly Py_ssize_t rows, size
    cdef Py_ssize_t _horizon, _moves, _count
    cdef bint _limits_rate
    cdef double _sample_time, _jerk_limit, _rate_limit, _terminal_weight, _terminal_margin, _jerk_weight, _step_weight
    cdef double _zmp_slack, _zmp_price, _end_slack, _end_price
    cdef const int64_t[::1] _ends
    cdef const double[:, :, ::1] _response
    cdef double[:, ::1] _S, _WS, _s, _box, _beside, _middle, _aim
    cdef double[::1] _Ws, _decay, _weights
    cdef NominalMotion _nominal

    cdef _look(self, Py_ssize_t count)
    cpdef build(self, problem)
    @cython.locals(axis=Py_ssize_t)
    cdef void _begin(self, const double[:, :] state, const double[:, :] point, const double[:] stiffness) noexcept
    @cython.locals(n=Py_ssize_t)
    cdef void _predict(self, const double[:, :] state, const double[:] stiffness, const double[:] omega,
                       const double[:, :] point, const double[:, :] gain, const double[:, :] half_size) noexcept
    cdef vector3 _free(self, Py_ssize_t axis, double time) noexcept nogil
    @cython.locals(m=Py_ssize_t, k=Py_ssize_t, j=Py_ssize_t, step=Py_ssize_t, axis=Py_ssize_t, x=double, a=double, _=double)
    cdef void _zmp_errors(self, const double[:] stiffness, const double[:, :] gain, const double[:, :] half_size) noexcept nogil
    @cython.locals(n=Py_ssize_t, m=Py_ssize_t, j=Py_ssize_t, step=Py_ssize_t, axis=Py_ssize_t, x=double, v=double, _=double)
    cdef void _end_errors(self, double omega, const double[:, :] gain, const double[:, :] half_size) noexcept nogil
    @cython.locals(k=Py_ssize_t, axis=Py_ssize_t)
    cdef void _box_around(self, const double[:, :] middle) noexcept
    @cython.locals(j=Py_ssize_t)
    cdef double _ahead(self, const double[:, :] values, Py_ssize_t column) noexcept nogil
    @cython.locals(n=Py_ssize_t, m=Py_ssize_t, i=Py_ssize_t, j=Py_ssize_t, k=Py_ssize_t, axis=Py_ssize_t, weight=double)
    cdef void _cost(self, double[:, ::1] P, double[:, ::1] q) noexcept nogil
    @cython.locals(n=Py_ssize_t, m=Py_ssize_t, k=Py_ssize_t, j=Py_ssize_t, axis=Py_ssize_t, above=Py_ssize_t, below=Py_ssize_t, slack=Py_ssize_t)
    cdef void _inequalities(self, double[:, ::1] G, double[:, ::1] h) noexcept nogil
    @cython.locals(m=Py_ssize_t, j=Py_ssize_t, axis=Py_ssize_t, above=Py_ssize_t, below=Py_ssize_t, change=double)
    cdef void _rate_limits(self, double[:, ::1] G, double[:, ::1] h, const double[:] last_jerk) noexcept nogil
    @cython.locals(m=Py_ssize_t, axis=Py_ssize_t, begin=Py_ssize_t, move=Py_ssize_t, k=Py_ssize_t, step=Py_ssize_t, slack=Py_ssize_t, lowest=double, highest=double)
    cdef void _bounds(self, double[:, ::1] lower, double[:, ::1] upper, const double[:, :] least, const double[:, :] most) noexcept nogil
