"""Physics regression: metrics of runs against those that were kept."""
