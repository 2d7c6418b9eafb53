"""From a scenario to a resolved walk: what a scenario file means."""
