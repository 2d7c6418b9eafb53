from surefoot.planner.model.time_scaling cimport TimeScaling
from surefoot.planner.references.offset_table cimport OffsetTable
from surefoot.planner.plan.plan cimport WalkPlan
from surefoot.planner.references.zmp_reference cimport Support
from surefoot.planner.steps.phases cimport Phase
from surefoot.planner.steps.schedule cimport Schedule
from surefoot.planner.swing.trajectory cimport SwingTrajectory
from surefoot.planner.walk_model cimport WalkModel

cdef class Swing:
    cdef readonly object stage
    cdef readonly SwingTrajectory trajectory
    cdef readonly int waited

cdef class HeightMemory:
    cdef readonly object tick, course, height
    cdef readonly double lower

cdef class Memory:
    cdef readonly Support support
    cdef readonly OffsetTable offsets
    cdef readonly object transition
    cdef readonly HeightMemory height

cdef class Orders:
    cdef readonly object source, new

cdef class WalkState:
    cdef readonly WalkModel model
    cdef readonly Schedule schedule
    cdef readonly TimeScaling clock
    cdef readonly Phase phase
    cdef readonly bint stops
    cdef readonly Py_ssize_t landed
    cdef readonly Swing swing
    cdef readonly bint adapted
    cdef readonly double lowering, astray
    cdef readonly Memory memory
    cdef readonly Orders orders
    cdef readonly WalkPlan plan
    cdef readonly object law_memory
