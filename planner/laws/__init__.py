"""Laws of motion: what decides jerk and footsteps of a tick, and the profiles made of them."""
