"""A closed loop that needs no engine, for the tests of this folder."""

from fake_walks import motion, robot

__all__ = ["motion", "robot"]
