cimport cython
cimport libc.math as math
from surefoot.maths.algebra cimport vector3
from surefoot.planner.geometry cimport quintic
from surefoot.planner.references cimport com_height
from surefoot.planner.steps.phases cimport PhaseSamples

cdef Py_ssize_t _DOUBLE, _SINGLE
cdef double _PI
cdef vector3 _REST

@cython.locals(
    which=Py_ssize_t[::1], kind=Py_ssize_t[::1], elapsed=double[::1], length=double[::1], fraction=double[::1],
    fraction_rate=double[::1], t=double, omega=double, half=double, edge=vector3, z=vector3, lasting=double,
    begins=cython.bint, ends=cython.bint, k=Py_ssize_t,
)
cdef void _fill(
    PhaseSamples samples, double apex, double swinging, double standing, const unsigned char[:, ::1] rests,
    double[:, ::1] wave,
)
@cython.locals(more=double, phase=double, rise=vector3)
cdef vector3 _through(double apex, double first, double way, double omega, double share, double lasting) noexcept nogil
@cython.locals(c=double, s=double, a=double)
cdef vector3 _cosine(double apex, double phase, double rate, double bend) noexcept nogil
cdef vector3 _from_rest(vector3 end, double share, double lasting) noexcept nogil
