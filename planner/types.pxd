cdef class Footstep:
    cdef readonly object foot, position
    cdef readonly double yaw
    cdef readonly object normal
    cdef readonly Py_ssize_t step
    cdef readonly double touchdown_time

cdef class CentroidalState:
    cdef readonly double time
    cdef readonly object com, com_velocity, lasting, deviation

cdef class FeetState:
    cdef readonly object position, yaw, contact
    cdef readonly double height_deviation
    cdef readonly object arriving

cdef class PlanStatus:
    cdef readonly object solver, zmp_slack, terminal_slack
    cdef readonly bint infeasible
    cdef readonly Py_ssize_t age, late_touchdown
    cdef readonly bint early_touchdown, falling
    cdef readonly object acted

cdef class Balance:
    cdef readonly double planned, movable
    cdef readonly object shift
    cdef readonly double delay
    cdef readonly Py_ssize_t lost
    cdef readonly bint catching
    cdef readonly Py_ssize_t safe

cdef class PhaseInfo:
    cdef readonly object kind, stance
    cdef readonly Py_ssize_t step
    cdef readonly double elapsed, duration
    cdef readonly Py_ssize_t leads_to
    cdef readonly double left

