"""The body: Pinocchio terms of a state, frames, soles, joint limits, distances of limbs, posture and statics."""
