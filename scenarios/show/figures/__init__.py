"""Figures of a log."""
