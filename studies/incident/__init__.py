"""From the log of an incident to the smallest scenario that shows it again."""
