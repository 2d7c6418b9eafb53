cimport cython
from surefoot.maths cimport algebra, linear
from surefoot.maths.algebra cimport vector3
from surefoot.planner.geometry cimport quintic
from surefoot.planner.plan.sample cimport PlanSample

cdef Py_ssize_t OMEGA, STIFFNESS, LOAD, LINEAR, HEIGHT, SWING, MOTIONS, RATES, BENDS, COLUMNS
cdef double ROUNDING

cdef class PlanSampler:
    cdef readonly object plan
    cdef object _contacts, _swing_foot
    cdef double _begin, _length, _touchdown, _lands, _start
    cdef Py_ssize_t _last, _entered
    cdef bint _landed
    cdef double[:, ::1] _table

    cpdef PlanSample sample(self, double time)
    @cython.locals(numbers=double[:, ::1], now=PlanSample, until=PlanSample)
    cpdef tick(self, double time, double middle)
    cdef PlanSample _sampled(self, double time, point, double[::1] numbers)
    @cython.locals(interval=Py_ssize_t, landed=cython.bint)
    cdef _go_to(self, double time)
    cdef _enter(self, Py_ssize_t i, bint landed)
    cdef _polynomials(self, swing, bint landed)
    @cython.locals(k=Py_ssize_t, i=Py_ssize_t)
    cdef void _fly(self, const double[:, :] polynomials) noexcept nogil
    @cython.locals(axis=Py_ssize_t)
    cdef void _line(self, Py_ssize_t column, const double[:, :] values, Py_ssize_t i) noexcept
    @cython.locals(axis=Py_ssize_t, here=vector3, there=vector3)
    cdef void _move(self, const double[:, :] com, const double[:, :] velocity, const double[:, :] acceleration,
                    const double[:, :] jerk, Py_ssize_t i) noexcept
    @cython.locals(k=Py_ssize_t, i=Py_ssize_t)
    cdef void _derive(self) noexcept nogil
    @cython.locals(axis=Py_ssize_t)
    cdef void _evaluate(self, double t, double[::1] point) noexcept nogil
