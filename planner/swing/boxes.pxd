cimport cython

@cython.locals(box=Py_ssize_t, near=double, far=double)
cpdef landing_boxes(
    double[:, :] low, double[:, :] high, (double, double, double, double) extents, double across, double side,
    const double[:, :] face, Py_ssize_t count
)
