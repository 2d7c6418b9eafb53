"""The programs: the command line, the robot live in a browser page, robot files."""
