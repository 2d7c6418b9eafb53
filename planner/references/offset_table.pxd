cdef class OffsetTable:
    cdef readonly Py_ssize_t start
    cdef readonly object key, course, aim, values
    cdef readonly Py_ssize_t ticks
