cimport cython
from surefoot.maths cimport algebra, linear
from surefoot.wbc.body.model cimport RobotTerms
from surefoot.wbc.types cimport WbcAnswer

cdef class AnswerReader:
    cdef readonly WbcAnswer answer
    cdef Py_ssize_t _joints, _nv
    cdef double _fading, _damping
    cdef const double[::1] _limit, _target, _unscale
    cdef const double[:, ::1] _torque_rows, _rows
    cdef double[::1] _torque, _acceleration, _wrench, _task_error

    @cython.locals(unit=double, i=Py_ssize_t)
    cpdef read(self, RobotTerms terms, const double[::1] x)
    cpdef see_soles(self, shifted)
    cpdef fade(self, v)
    @cython.locals(j=Py_ssize_t)
    cdef void _clip(self) noexcept
