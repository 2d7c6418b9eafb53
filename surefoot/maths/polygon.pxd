cimport cython

cdef double FLAT, ROUNDING

@cython.locals(
    found=Py_ssize_t, first=Py_ssize_t, k=Py_ssize_t, i=Py_ssize_t, upper=Py_ssize_t, x=double, y=double
)
cpdef Py_ssize_t hull(double[:, ::1] points, Py_ssize_t count, double[:, ::1] vertices) noexcept nogil
@cython.locals(k=Py_ssize_t, x=double, y=double, left=double, right=double, below=double, above=double, extent=double, most=double)
cpdef double flatness(const double[:, ::1] points, Py_ssize_t count) noexcept nogil
@cython.locals(ax=double, ay=double, bx=double, by=double)
cdef double _left_turn(
    double[:, ::1] vertices, Py_ssize_t a, Py_ssize_t b, double[:, ::1] points, Py_ssize_t c
) noexcept nogil
