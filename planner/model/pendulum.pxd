cimport libc.math as math

cpdef double moving_cop(double start, double end, double omega, double time) noexcept nogil
cpdef double com_after(double com, double dcm, double cop, double growth) noexcept nogil
