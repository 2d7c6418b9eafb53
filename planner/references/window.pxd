cdef class Window:
    cdef readonly object reference, driving, offset, height, stiffness, omega, load_left, contacts
