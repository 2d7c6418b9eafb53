cimport cython
from surefoot.maths cimport linear
from surefoot.wbc.body.model cimport RobotTerms
from surefoot.wbc.reference cimport WbcReference
from surefoot.wbc.tasks.diagonal cimport DiagonalTerm
from surefoot.wbc.tasks.law cimport Place

cdef class TaskStack:
    cdef readonly object layout, rows, target, diagonal, linear, scale, unscale
    cdef readonly bint catching
    cdef object _scales, _unscales
    cdef list _places, _terms
    cdef double[:, ::1] _T, _H
    cdef double[::1] _t, _root_W, _D, _d, _g

    @cython.locals(place=Place, term=DiagonalTerm)
    cpdef write(self, RobotTerms terms, WbcReference reference)
    @cython.locals(i=Py_ssize_t)
    cdef void _assemble(self) noexcept nogil
