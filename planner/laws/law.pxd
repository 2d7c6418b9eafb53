from surefoot.maths cimport linear

cdef class StepContext:
    cdef readonly object increment, side, free, swing
    cdef readonly double time_left, transfer_time
    cdef readonly object lower, upper

cdef class MotionProblem:
    cdef readonly object state, stiffness, omega, reference, steps, last_jerk, fallback, rotation, memory

cdef class Motion:
    cdef readonly object jerk, shifts, zmp_slack, terminal_slack, solver
    cdef readonly bint infeasible
    cdef readonly object qps, memory

cdef class BuiltQps:
    cdef readonly object axes, jerk, shifts
