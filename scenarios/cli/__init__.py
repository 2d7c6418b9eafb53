"""The command line: its own commands, and those that other floors and packages bring by entry point."""
