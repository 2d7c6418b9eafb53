"""False alarms and power of a check over seeds, measured on two robots and three scenarios."""
