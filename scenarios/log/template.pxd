cimport cython

cdef long long _SECONDS_TAG, _NANOS_TAG

cdef class Template:
    cdef readonly Py_ssize_t size
    cdef object _bytes
    cdef const Py_ssize_t[:, ::1] _places
    cdef const Py_ssize_t[::1] _stamps

    cpdef encode(self, time_ns, values)
    @cython.locals(k=Py_ssize_t, i=Py_ssize_t)
    cdef void _write(
        self, unsigned char[::1] message, const unsigned char[::1] values, long long seconds, long long nanos
    ) noexcept nogil

cdef void _put_stamp(unsigned char[::1] message, Py_ssize_t place, long long seconds, long long nanos) noexcept nogil
@cython.locals(k=Py_ssize_t)
cdef void _put_varint(unsigned char[::1] message, Py_ssize_t place, long long value) noexcept nogil
