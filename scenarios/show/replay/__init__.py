"""A log in 3D: page, video, live."""
