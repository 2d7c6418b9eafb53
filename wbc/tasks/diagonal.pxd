cimport cython
from surefoot.wbc.tasks.arm_swing cimport ArmSwing
from surefoot.wbc.body.model cimport RobotTerms
from surefoot.wbc.reference cimport WbcReference

cdef class DiagonalTerm:
    cdef void put(self, RobotTerms terms, WbcReference reference, double[::1] linear) noexcept

cdef class Regularisation(DiagonalTerm):
    cdef object _weight

cdef class Posture(DiagonalTerm):
    cdef ArmSwing _arms
    cdef double[::1] _W, _K, _D, _pull

    @cython.locals(j=Py_ssize_t, arms=ArmSwing, angle=double, rate=double, acceleration=double, left=double, right=double)
    cdef void put(self, RobotTerms terms, WbcReference reference, double[::1] linear) noexcept

cdef class ForceDistribution(DiagonalTerm):
    cdef double _force, _moment, _unit, _g

    @cython.locals(weight=double)
    cdef void put(self, RobotTerms terms, WbcReference reference, double[::1] linear) noexcept
