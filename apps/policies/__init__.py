"""Learned controllers: the contract of a network is begun, and checked."""
