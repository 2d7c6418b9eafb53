cimport cython
from surefoot.maths cimport algebra
from surefoot.planner.model cimport dcm as law

cdef Py_ssize_t COLUMNS

cdef class Outlook:
    cdef double sample_time, _foot_margin
    cdef Py_ssize_t count
    cdef const double[:] stiffness, omega
    cdef const double[:, :] point, gain, half_size, middle
    cdef double[::1] decay, _ahead, _next
    cdef double[:, ::1] bounded

    cdef void _resize(self, Py_ssize_t count)
    cpdef see(self, window)
    @cython.locals(k=Py_ssize_t, axis=Py_ssize_t, margin=double)
    cpdef double margin(self, const double[:] dcm, window)
    @cython.locals(k=Py_ssize_t, axis=Py_ssize_t)
    cpdef nominal(self, window)
    cdef void look(self, Py_ssize_t lift, Py_ssize_t lands) noexcept
    cdef double _driving(self, Py_ssize_t k, Py_ssize_t column, Py_ssize_t lift) noexcept
    cdef void _note(self, Py_ssize_t row, Py_ssize_t k) noexcept
