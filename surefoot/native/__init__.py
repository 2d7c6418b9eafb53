"""How modules are compiled: which, when, and what they run as where they are not."""
