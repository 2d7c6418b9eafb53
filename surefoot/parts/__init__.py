"""Parts of other packages: how they are found and registered, and what stands around their calls."""
