"""Logs for the eyes: figures, and one run beside another."""
