from surefoot.planner.state cimport WalkState
