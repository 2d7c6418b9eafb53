from surefoot.readings cimport Reading, Readings

cdef class ReadingsRecorder:
    cdef object _row, _no_velocity, _no_wrench

    cpdef tick(self, time_ns, Readings readings)
