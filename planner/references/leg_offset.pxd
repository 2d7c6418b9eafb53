cimport cython
from surefoot.planner.model.leg_body cimport Body
from surefoot.planner.model.nominal cimport NominalMotion
from surefoot.planner.references.nominal_feet cimport NominalFeet

cdef double GRAVITY

cdef class LegOffset:
    cdef double _softening, _sample_time
    cdef Body _body
    cdef NominalFeet _feet
    cdef NominalMotion _motion
    cdef double[:, ::1] _com

    @cython.locals(n=Py_ssize_t, passes=Py_ssize_t, body=Body, feet=NominalFeet)
    cpdef made(self, moving, point, height, position, guess)
    @cython.locals(axis=Py_ssize_t, k=Py_ssize_t, com=double[:, ::1], motion=NominalMotion)
    cdef void _place_com(self, const double[:, :] height, Py_ssize_t n)
    @cython.locals(k=Py_ssize_t, last=Py_ssize_t, rate=double[:, ::1], a=double[:, ::1])
    cdef void _tell(self, const double[:, :] height, const double[:] stiffness, const double[:] softened, double[:, ::1] offset)
