"""``surefoot policy``: contracts of learned controllers."""
