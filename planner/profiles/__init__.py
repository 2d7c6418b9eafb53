"""Planner profiles: formulations of the same walk behind one interface (`planner.motion`), to be compared."""
