cdef class RobotState:
    cdef readonly object q, v

cdef class FootSensing:
    cdef readonly (double, double) normal_force
    cdef readonly object wrench, contact
    cdef readonly (double, double) load_deviation
    cdef readonly double wrench_age
    cdef readonly (bint, bint) touching

cdef class WbcReport:
    cdef readonly object torque, status
    cdef readonly Py_ssize_t iterations
    cdef readonly double primal_residual, dual_residual
    cdef readonly object acceleration, wrench
    cdef readonly (bint, bint) active, felt
    cdef readonly (Py_ssize_t, Py_ssize_t) edge
    cdef readonly object task_error
    cdef readonly double build_time, solve_time
    cdef readonly object load

cdef class WbcAnswer:
    cdef readonly object torque, acceleration, wrench, task_error
