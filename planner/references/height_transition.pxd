cimport cython
from surefoot.maths cimport algebra
from surefoot.maths.algebra cimport vector3
from surefoot.planner.geometry cimport quintic
from surefoot.planner.geometry.quintic cimport quintic6

cdef Py_ssize_t _LOOKED_AT
cdef double _ROUNDING

@cython.locals(
    last=Py_ssize_t, best=Py_ssize_t, samples=Py_ssize_t, i=Py_ssize_t, least=double, hardest=double, lasting=double,
    end=vector3, way=quintic6,
)
cpdef Py_ssize_t soonest_calm(const double[:, :] height, vector3 now, Py_ssize_t soonest, double bound, double sample_time) noexcept
