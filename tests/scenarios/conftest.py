"""A closed loop that needs no engine, for the tests of this folder."""

from fake_walks import motion, robot, robots, same_content_fixture, two_steps

__all__ = ["motion", "robot", "robots", "same_content_fixture", "two_steps"]
