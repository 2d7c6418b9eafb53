"""MuJoCo world: terrain geometry, sensors, pushes and rendering."""
