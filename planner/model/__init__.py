"""Models of the body: jerk-driven CoM, DCM, leg chain, and the filter of the planner's state."""
