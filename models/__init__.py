"""Robot descriptions: one MJCF text per robot, read by MuJoCo and by Pinocchio."""
