cimport cython
from surefoot.planner.measured cimport Measured
from surefoot.planner.state cimport Swing, WalkState
from surefoot.planner.steps.step cimport Step
from surefoot.planner.swing.trajectory cimport SwingTrajectory
from surefoot.planner.types cimport FeetState, Footstep

@cython.locals(step=Step, place=Footstep, ahead=double, left=double, x=double, y=double)
cpdef upcoming(WalkState state, double time, shifts)
cdef Footstep _shifted(WalkState state, Footstep place, double ahead, double left)
@cython.locals(stance=Footstep, swing=SwingTrajectory, flown=Swing, astray=double, lowering=double, time=double)
cpdef WalkState swinging_to(WalkState state, Footstep landing, Measured measured, bint held)
cdef SwingTrajectory _begun(WalkState state, Footstep landing, double time, FeetState feet, double astray)
cdef SwingTrajectory _aimed(WalkState state, SwingTrajectory swing, Footstep landing, double time)
