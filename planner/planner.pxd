cimport cython
from surefoot.planner.laws.law cimport Motion
from surefoot.planner.look cimport View
from surefoot.planner.measured cimport Measured
from surefoot.planner.references.window cimport Window
from surefoot.planner.references.zmp_reference cimport Support, ZmpReference
from surefoot.planner.state cimport Swing, WalkState
from surefoot.planner.types cimport Balance
from surefoot.planner.plan.plan cimport WalkPlan
from surefoot.planner.walk_model cimport WalkModel

@cython.locals(state=WalkState, support=Support, measured=Measured, balance=Balance)
cpdef planned(View view, Motion motion, acted)
@cython.locals(support=Support, window=Window, model=WalkModel, reference=ZmpReference)
cdef WalkPlan _world_plan(View view, WalkState state, Motion motion, footsteps, status, Balance balance)
@cython.locals(last=WalkPlan, swing=Swing)
cdef _status(WalkState state, Motion motion, Balance balance, acted)
