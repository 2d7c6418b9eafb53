"""The plan as it is handed over: its values, what it says of one instant, and its samples in between."""
