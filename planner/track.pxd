cimport cython
from surefoot.planner.measured cimport Measured
from surefoot.planner.model.time_scaling cimport TimeScaling
from surefoot.planner.state cimport Swing, WalkState
from surefoot.planner.steps.phases cimport Phase
from surefoot.planner.swing.trajectory cimport SwingTrajectory
from surefoot.planner.types cimport FeetState

cpdef WalkState track(WalkState state, Measured measured)
@cython.locals(clock=TimeScaling, phase=Phase, feet=FeetState, over=cython.bint)
cpdef WalkState advanced(WalkState state, Measured measured)
@cython.locals(phase=Phase, swing=Swing, feet=FeetState)
cdef WalkState _swung(WalkState state, Measured measured, TimeScaling clock, bint over)
cpdef bint lands_short(WalkState state, Measured measured) except -1
cpdef WalkState obeyed(WalkState state, double time)
@cython.locals(swing=SwingTrajectory, frozen=double, lost=cython.bint, late=double)
cpdef WalkState decided(WalkState state, Measured measured)
