cimport cython
from surefoot.readings cimport Reading, Readings
from surefoot.sim.measurement cimport Measurement
from surefoot.wbc.estimation.estimate cimport Deviation, Estimate, Planned

cdef class Senses:
    cdef readonly bint is_truth, reads, listens
    cdef object _sense, _estimate, _told
    cdef Estimate _last

    cpdef told(self, reference, report)

@cython.locals(sure=Deviation, age=double)
cpdef foot_sensing(Estimate estimate, wrench, bint wanted, inferred=*, touching=*)
