from surefoot.planner.types cimport Balance, PhaseInfo, PlanStatus
from surefoot.planner.swing.sway cimport Pelvis
from surefoot.planner.swing.trajectory cimport SwingTrajectory

cdef class WalkPlan:
    cdef readonly double time, sample_time
    cdef readonly object com, com_velocity, com_acceleration, jerk, zmp, zmp_offset, zmp_reference, stiffness, omega
    cdef readonly PhaseInfo phase
    cdef readonly object contacts, load_left, support_polygon, inner_polygon, footholds, footsteps
    cdef readonly SwingTrajectory swing
    cdef readonly tuple rolls
    cdef readonly PlanStatus status
    cdef readonly Balance balance
    cdef readonly Pelvis pelvis
