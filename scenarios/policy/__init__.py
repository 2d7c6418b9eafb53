"""Learned controllers: a network, and the contract that tells what it observes and what its outputs mean."""
