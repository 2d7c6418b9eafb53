cimport cython
cimport libc.math as math

@cython.locals(found="double[:, ::1]", k=Py_ssize_t, x=double, y=double, z=double, edge=double, flat=double)
cpdef level(const double[:, :] position, const double[:, :, :] rotation, double toe, double heel)
cpdef yaws(const double[:, :, :] rotation)
