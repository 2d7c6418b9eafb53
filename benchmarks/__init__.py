"""Measurements of what Surefoot costs; ``python -m benchmarks`` prints their table (see docs/benchmarks.md)."""
