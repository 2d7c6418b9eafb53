"""Stances and first steps that a walk asks of its robot, before it begins."""
