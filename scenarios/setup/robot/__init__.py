"""The robot of a scenario, from its description to a body that stands."""
