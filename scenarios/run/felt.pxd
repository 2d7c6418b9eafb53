cdef class FeltGait:
    cdef double _least, _graze, _still, _began, _now
    cdef object _usual, _kind
    cdef list _other
    cdef readonly tuple contact
    cdef readonly int step
    cdef readonly object landed

    cpdef update(self, double now, forces)
    cdef _change(self, tuple contact)
    cdef bint _settled(self, int foot, double force)
