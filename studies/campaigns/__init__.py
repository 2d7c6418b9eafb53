"""``surefoot sweep``: campaigns of runs over any key, as a table, thresholds and a page."""
