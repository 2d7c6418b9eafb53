"""The closed loops of both fidelities, put together from a scenario."""
