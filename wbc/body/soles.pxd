cimport cython
cimport libc.math as math

@cython.locals(found="double[:, ::1]", k=Py_ssize_t, x=double, y=double, z=double, edge=double, flat=double, up=double, u=double, v=double, w=double)
cpdef level(const double[:, :] position, const double[:, :, :] rotation, double toe, double heel, const double[:, :] normal)
cpdef yaws(const double[:, :, :] rotation)
