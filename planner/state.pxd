cdef class Swing:
    cdef readonly object stage, trajectory
    cdef readonly int waited
    cdef readonly bint again

cdef class HeightMemory:
    cdef readonly object tick, course, height
    cdef readonly double lower

cdef class Memory:
    cdef readonly object support, offsets, transition, height

cdef class Orders:
    cdef readonly object source, new

cdef class WalkState:
    cdef readonly object model, schedule, clock, phase
    cdef readonly bint stops
    cdef readonly object landed
    cdef readonly Swing swing
    cdef readonly bint adapted
    cdef readonly double lowering, astray
    cdef readonly Memory memory
    cdef readonly Orders orders
    cdef readonly object plan
