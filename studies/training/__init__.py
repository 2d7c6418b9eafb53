"""The robot as an environment of those who train policies."""
