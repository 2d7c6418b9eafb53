"""Checks of a scenario: what is refused, what a criterion may be, and what is worth a note."""
