cimport libc.math as math
cimport cython

ctypedef (double, double, double) vector3
ctypedef (vector3, vector3, vector3) rows3

cdef double INFINITY
cpdef double between(double value, double low, double high) noexcept nogil
cpdef double clamp(double value, double low, double high) noexcept nogil
cpdef double square(double value) noexcept nogil
cpdef vector3 add(vector3 a, vector3 b) noexcept nogil
cpdef vector3 subtract(vector3 a, vector3 b) noexcept nogil
cpdef vector3 scale(double factor, vector3 a) noexcept nogil
cpdef vector3 squares(vector3 a) noexcept nogil
cpdef vector3 cross(vector3 a, vector3 b) noexcept nogil
cpdef double inner(vector3 a, vector3 b) noexcept nogil
cpdef vector3 vector(const double[:] values) noexcept nogil
cpdef void put(double[:] out, vector3 a) noexcept nogil
cpdef vector3 row(const double[:, :] A, Py_ssize_t i, Py_ssize_t first=*) noexcept nogil
cpdef void put_row(double[:, :] A, Py_ssize_t i, vector3 a, Py_ssize_t first=*) noexcept nogil
cpdef vector3 column(const double[:, :] A, Py_ssize_t j, Py_ssize_t first=*) noexcept nogil
cpdef void put_column(double[:, :] A, Py_ssize_t j, vector3 a, Py_ssize_t first=*) noexcept nogil
cpdef void put_cross(double[:, :] out, vector3 a) noexcept nogil
cpdef vector3 rotate(const double[:, :] R, vector3 a) noexcept nogil
cpdef vector3 rotate_back(const double[:, :] R, vector3 a) noexcept nogil
@cython.locals(i=Py_ssize_t, j=Py_ssize_t)
cpdef void compose(const double[:, :] A, const double[:, :] B, double[:, :] out) noexcept nogil
@cython.locals(i=Py_ssize_t, j=Py_ssize_t)
cpdef void compose_back(const double[:, :] A, const double[:, :] B, double[:, :] out) noexcept nogil
@cython.locals(small=cython.bint)
cpdef void rotation_of(vector3 a, double[:, :] R) noexcept nogil
cpdef rows3 quaternion_rows(double x, double y, double z, double w) noexcept nogil
cpdef vector3 rotation_vector(const double[:, :] R) noexcept nogil
cpdef vector3 turn_between(const double[:, :] A, const double[:, :] B) noexcept nogil
cpdef double columns_inner(const double[:, :] A, Py_ssize_t i, const double[:, :] B, Py_ssize_t j) noexcept nogil
cdef vector3 _logarithm(vector3 axis, double trace) noexcept nogil
cpdef (vector3, vector3) see_motion(const double[:, :] R, vector3 p, vector3 linear, vector3 angular) noexcept nogil
@cython.locals(j=Py_ssize_t)
cpdef void see_wrench(const double[:, :] R, vector3 p, double[:, :] out) noexcept nogil
@cython.locals(i=Py_ssize_t, j=Py_ssize_t, k=Py_ssize_t)
cpdef void quaternion(const double[:, :] R, double[:] out) noexcept nogil
