cimport cython
from surefoot.maths cimport algebra
from surefoot.maths.algebra cimport vector3
from surefoot.wbc.body.model cimport RobotTerms
from surefoot.wbc.reference cimport WbcReference

cdef class TaskLaw:
    cdef void put(
        self, RobotTerms terms, WbcReference reference, const double[::1] scale, double[:, ::1] rows, double[::1] target
    ) noexcept

cdef class Place:
    cdef object _task, _arrays
    cdef TaskLaw _law
    cdef const double[::1] _scale
    cdef double[:, ::1] _rows
    cdef double[::1] _target

    cdef int put(self, RobotTerms terms, WbcReference reference) except -1

cpdef vector3 angular_feedback(
    double stiffness, double damping, const double[:, :] R, vector3 velocity, const double[:, :] desired, vector3 ahead
) noexcept nogil
