cimport cython
cimport libc.math as math
from surefoot.wbc.qp.range_space cimport EqualityQp, InequalityQp

cdef class QpSolution:
    cdef readonly object x
    cdef readonly double violation
    cdef readonly Py_ssize_t iterations
    cdef readonly double dual_residual

cdef class EqualityFirst:
    cdef double _accuracy
    cdef object _full
    cdef EqualityQp _equalities
    cdef InequalityQp _inequalities

    @cython.locals(equalities=EqualityQp, violation=double, rounds=Py_ssize_t)
    cpdef solve(self, qp)
