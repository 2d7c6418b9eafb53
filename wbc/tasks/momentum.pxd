cimport cython
from surefoot.maths cimport algebra, linear
from surefoot.maths.algebra cimport vector3
from surefoot.wbc.tasks.balance cimport BalanceLaw
from surefoot.wbc.body.model cimport RobotTerms
from surefoot.wbc.reference cimport WbcReference
from surefoot.wbc.tasks.law cimport TaskLaw

cdef class CentreOfMass(TaskLaw):
    cdef public object weight, catching_weight
    cdef BalanceLaw _balance
    cdef double _g

    @cython.locals(m=double)
    cdef void put(
        self, RobotTerms terms, WbcReference reference, const double[::1] scale, double[:, ::1] rows, double[::1] target
    ) noexcept

cdef class AngularMomentum(TaskLaw):
    cdef public object weight, catching_weight
    cdef double _k

    @cython.locals(i=Py_ssize_t, j=Py_ssize_t, nv=Py_ssize_t, m=double, s=double, F=vector3, M=vector3)
    cdef void put(
        self, RobotTerms terms, WbcReference reference, const double[::1] scale, double[:, ::1] rows, double[::1] target
    ) noexcept
