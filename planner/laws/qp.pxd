cdef class Qp:
    cdef readonly object P, q, G, h, lower, upper

cdef class QpSolution:
    cdef readonly object qp, z
    cdef readonly Py_ssize_t attempt
