from surefoot.maths.algebra cimport vector3
from surefoot.planner.geometry cimport quintic

cdef class Sway:
    cdef readonly double start, end, target
    cdef readonly quintic.quintic6 course

    cpdef vector3 evaluate(self, double time)

cdef class Pelvis:
    cdef readonly Sway yaw, roll
