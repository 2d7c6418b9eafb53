"""The engines as everybody here sees them: MuJoCo without its windows, and Pinocchio with joints that follow others."""
