"""Geometry of feet on the ground: frames of the plane, polygons, the orientation of soles, and quintic curves."""
