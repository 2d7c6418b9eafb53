"""Composition root: scenario files, closed loop, MCAP log, metrics, verdict and command line."""
