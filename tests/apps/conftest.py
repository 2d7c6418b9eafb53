"""A closed loop that needs no engine, for the tests of this folder."""

from fake_walks import same_content_fixture

__all__ = ["same_content_fixture"]
