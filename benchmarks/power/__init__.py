"""How rarely a check over seeds cries, and what it finds: measured on two robots and three scenarios."""
