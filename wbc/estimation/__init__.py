"""State estimation: from the readings of the robot's own sensors to the state that planner and controller are given."""
