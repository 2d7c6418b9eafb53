cdef class ClosedLoop:
    cdef readonly object walker, planning, rate
    cdef readonly long long tick
    cdef readonly object sample, end
    cdef readonly bint fell, done
    cdef readonly object fault
    cdef object _recorder, _instruments
    cdef list _pushes, _begun
    cdef long long _ticks, _last, _ahead

    cpdef sense(self)
    cpdef step(self)
    cdef _step(self, long long tick)
    cdef _push(self, double now, double since, phase)
