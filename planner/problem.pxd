cimport cython
from surefoot.planner.look cimport View
from surefoot.planner.references.window cimport Window
from surefoot.planner.state cimport WalkState
from surefoot.planner.steps.schedule cimport Schedule
from surefoot.planner.walk_model cimport WalkModel

@cython.locals(state=WalkState, window=Window)
cpdef problem_of(View view)
@cython.locals(state=WalkState)
cdef _steps(View view)
@cython.locals(state=WalkState, model=WalkModel, schedule=Schedule)
cdef _bounds(View view, increment, here, double left)
