"""Robot files: a few lines of YAML beside any URDF or MJCF, and all else of a robot derived from that model."""
