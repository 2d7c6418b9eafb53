from surefoot.maths.algebra cimport vector3

ctypedef (double, double, double, double, double, double) quintic6

cpdef double value(quintic6 c, double t) noexcept nogil
cpdef double slope(quintic6 c, double t) noexcept nogil
cpdef double bend(quintic6 c, double t) noexcept nogil
cpdef quintic6 between(vector3 start, vector3 end, double t) noexcept nogil
