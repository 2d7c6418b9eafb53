"""A robot of one's own: what of it was found, and what of the catalogue it walks."""
