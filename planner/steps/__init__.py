"""The walk: gait, commands, where feet may go, footsteps, and the clock."""
