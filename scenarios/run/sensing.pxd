cdef class TrueState:
    cdef object _state
