from surefoot.readings cimport Reading, Readings
from surefoot.sim.measurement cimport Measurement
from surefoot.wbc.estimation.estimate cimport Deviation, Estimate, Planned

cdef class Senses:
    cdef readonly bint is_truth, reads, listens
    cdef object _sense, _estimate, _feed
    cdef Estimate _last

    cpdef feed_back(self, reference, report)
