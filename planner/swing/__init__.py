"""The swing foot: its trajectory, its course over edges, and the roll of the foot that leaves the ground."""
