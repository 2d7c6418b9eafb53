cdef class JointColumns:
    cdef object _data, _joined
    cdef readonly object values

    cpdef update(self)

cdef class Dynamics:
    cdef object _model, _tree, _still
    cdef readonly object data, C

    cpdef all_terms(self, q, v)
    cpdef mass_matrix(self, q)
    cpdef coriolis(self, q, v)
