"""The ground: terrain as data, and the kinds of it that are built."""
