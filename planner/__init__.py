"""Walking planner: points, pendulums, footsteps and terrain heights; it knows no robot and no simulator."""
