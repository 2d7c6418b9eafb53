cimport cython
cimport libc.math as math

@cython.locals(k=Py_ssize_t, last=Py_ssize_t, w=double)
cpdef void integrate_riccati(const double[:] stiffness, double sample_time, double[:] omega) noexcept nogil
@cython.locals(k=Py_ssize_t)
cpdef void fade(const double[:] stiffness, const double[:] omega, double sample_time, double[:] decay) noexcept nogil
@cython.locals(k=Py_ssize_t)
cpdef void weigh(const double[:] decay, double[:] weights) noexcept nogil
cpdef double weight(const double[:] decay, Py_ssize_t k) noexcept nogil
@cython.locals(last=Py_ssize_t, counted=double)
cpdef double share(const double[:] decay, Py_ssize_t k) noexcept nogil
@cython.locals(k=Py_ssize_t, ahead=double, following=double)
cpdef void gather(const double[:] decay, const double[:] zmp, double[:] bounded) noexcept nogil
