"""The robot driven live: commands and pushes from a browser page, real time, everything in a log."""
