cdef class ClosedLoop:
    cdef readonly object walker, planning, rate, end, fault
    cdef readonly long long tick
    cdef readonly bint fell, done
    cdef object _recorder
    cdef list _pushes, _begun
    cdef long long _ticks, _last

    cpdef step(self)
    cdef _step(self, long long tick)
    cdef _push(self, double now, plan)
