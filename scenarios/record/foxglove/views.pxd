cdef class EventLog:
    cdef object _channel
    cdef tuple _last

    cpdef update(self, time_ns, contact, force, bint fallback, bint falling, bint fallen, tuple acted=*)

cdef class RobotView:
    cdef readonly long long every
    cdef object _poses, _torso, _tf, _joints, _forces, _scene, _scene_data, _levers
    cdef long long _scene_every

    cpdef picture(self, long long tick, time_ns, measurement, terms, plan=*, sample=*)
    cdef _planned(self, time_ns, measurement, terms, plan, sample)

cdef class SeatView(RobotView):
    cdef EventLog _events

    cpdef events(self, time_ns, measurement, contact, bint fallen)

cdef class BodyView(RobotView):
    cdef object _walk
    cdef EventLog _events

    cpdef events(self, time_ns, measurement, report, plan, bint fallen)
    cdef _planned(self, time_ns, measurement, terms, plan, sample)
