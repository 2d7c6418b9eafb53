cimport cython
from surefoot.maths cimport linear

cdef class Source:
    cdef object array
    cdef const double[::1] values

    cdef look(self, array, Py_ssize_t number)

cdef class RowWriter:
    cdef list _writers, _fields, _sources, _times
    cdef object _derived, _clock
    cdef double[:, ::1] _table
    cdef Py_ssize_t _width, _announced, _capacity

    @cython.locals(source=Source, k=Py_ssize_t, filled=Py_ssize_t)
    cdef _look(self, tuple vectors)
    @cython.locals(source=Source, k=Py_ssize_t, column=Py_ssize_t)
    cdef _fill(self, double[::1] row, tuple numbers)
    cpdef drop(self)
    cpdef spread(self)
