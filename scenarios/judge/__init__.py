"""From a log to metrics, health and verdict."""
