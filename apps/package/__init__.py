"""A package of one's own to start from: ``surefoot new``."""
