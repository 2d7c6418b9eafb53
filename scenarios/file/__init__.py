"""The scenario file: its keys, how it is read and checked, and what it means in the planner's terms."""
