cdef class EventLog:
    cdef object _channel
    cdef tuple _last

    cpdef update(self, time_ns, contact, bint pushed, bint fallback, bint falling, bint fallen)

cdef class BodyView:
    cdef readonly long long every
    cdef object _poses, _torso, _tf, _joints, _forces, _scene, _scene_data, _walk, _levers
    cdef long long _scene_every
    cdef EventLog _events

    cpdef events(self, time_ns, measurement, report, plan, bint fallen)
    cpdef picture(self, long long tick, time_ns, measurement, terms, plan, sample)
