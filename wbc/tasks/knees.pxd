cimport cython
from surefoot.wbc.body.model cimport RobotTerms
from surefoot.wbc.reference cimport WbcReference
from surefoot.wbc.tasks.law cimport TaskLaw

cdef class StanceKnees(TaskLaw):
    cdef public object weight, catching_weight
    cdef double _k, _d
    cdef const long long[::1] _columns
    cdef const double[::1] _angles

    @cython.locals(k=Py_ssize_t, column=Py_ssize_t, share=double, wanted=double)
    cdef void put(
        self, RobotTerms terms, WbcReference reference, const double[::1] scale, double[:, ::1] rows, double[::1] target
    ) noexcept
