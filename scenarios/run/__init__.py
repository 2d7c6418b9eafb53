"""The closed loops of both fidelities, and the run around them."""
