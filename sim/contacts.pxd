cdef class ContactSense:
    cdef object _contact, _code
    cdef bytes _geoms
    cdef tuple _touches

    cpdef read(self)
