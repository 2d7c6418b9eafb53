cimport cython
from surefoot.planner.measured cimport Measured
from surefoot.planner.model.time_scaling cimport TimeScaling
from surefoot.planner.references.com_height cimport HeightPreview
from surefoot.planner.references.offset_table cimport OffsetTable
from surefoot.planner.references.window cimport Window
from surefoot.planner.references.zmp_reference cimport Support, ZmpReference
from surefoot.planner.state cimport HeightMemory, Memory, WalkState
from surefoot.planner.steps.phases cimport PhaseSamples
from surefoot.planner.steps.step cimport Step
from surefoot.planner.swing.trajectory cimport SwingTrajectory
from surefoot.planner.types cimport Balance, PhaseInfo
from surefoot.planner.plan.plan cimport WalkPlan

cdef class View:
    cdef readonly WalkState state
    cdef readonly Measured measured
    cdef readonly Support support
    cdef readonly object local, dcm
    cdef readonly Window window
    cdef readonly double uncertainty
    cdef readonly object step
    cdef readonly Balance balance
    cdef readonly object bounds

@cython.locals(support=Support, window=Window)
cpdef View look(WalkState state, Measured measured)
@cython.locals(samples=PhaseSamples, whole=ZmpReference, reference=ZmpReference, high=HeightPreview, height=HeightPreview, table=OffsetTable, seen=Window, seen_height=HeightMemory)
cpdef references(WalkState state, Support support, position, double time, lasting)
@cython.locals(clock=TimeScaling, lower=double, leaves=cython.bint, before=HeightMemory, seen=HeightMemory)
cdef _transferred(WalkState state, law)
@cython.locals(clock=TimeScaling, table=OffsetTable, left=double, serves=cython.bint, swing=SwingTrajectory)
cdef _offsets(WalkState state, Support support, beyond, position, double time, lasting)
@cython.locals(phase=PhaseInfo, clock=TimeScaling, step=Step, stance=Step, swing=SwingTrajectory)
cpdef next_step(WalkState state, Measured measured, Support support)
cpdef counted_steps(WalkState state)
@cython.locals(last=WalkPlan, planned=double, movable=double, delay=double, before=Balance)
cpdef Balance weighed(WalkState state, body, Support support, Window window, step, double uncertainty)
