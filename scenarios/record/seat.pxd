from surefoot.scenarios.record.walk cimport RunRecorder

cdef class SeatRecorder(RunRecorder):
    cdef object _row, _names, _more

    cpdef tick(self, time_ns, measurement, truth, torque, contact, phase)
