from surefoot.planner.model.world_motion cimport WorldMotion
from surefoot.planner.recovery.capture_margin cimport CaptureMargin
from surefoot.planner.recovery.outlook cimport Outlook
from surefoot.planner.recovery.step_adjustment cimport StepAdjustment
from surefoot.planner.references.leg_offset cimport LegOffset
from surefoot.planner.swing.leg_reach cimport LegReach

cdef class WalkModel:
    cdef readonly object gait, ground, heights
    cdef readonly LegReach legs
    cdef readonly WorldMotion world
    cdef readonly Outlook outlook
    cdef readonly CaptureMargin margin
    cdef readonly StepAdjustment adjustment
    cdef readonly LegOffset leg_offset
    cdef readonly double softening
    cdef readonly object parameters, terrain, half_size
    cdef readonly int count, reach
    cdef readonly bint follows, adapts, times
    cdef readonly double hardest
