cimport cython
cimport libc.math as math
from surefoot.maths cimport algebra
from surefoot.maths.algebra cimport vector3
from surefoot.wbc.body.model cimport RobotTerms
from surefoot.wbc.reference cimport WbcReference

cdef class ArmSwing:
    cdef readonly Py_ssize_t left, right
    cdef readonly double gain, left_back, right_back

    @cython.locals(x=double, y=double, ahead=double)
    cpdef vector3 offset(self, RobotTerms terms, WbcReference reference) noexcept
