"""Surefoot: a humanoid walking stack in full physics."""
