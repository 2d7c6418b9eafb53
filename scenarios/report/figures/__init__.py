"""Figures of a log, one file per family, and the page that gathers them."""
