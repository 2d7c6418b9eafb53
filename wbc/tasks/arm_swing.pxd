cimport cython
cimport libc.math as math
from surefoot.maths cimport algebra
from surefoot.wbc.body.model cimport RobotTerms

cdef class ArmSwing:
    cdef readonly Py_ssize_t left, right
    cdef readonly double gain, left_back, right_back

    @cython.locals(x=double, y=double)
    cpdef (double, double) offset(self, RobotTerms terms) noexcept
