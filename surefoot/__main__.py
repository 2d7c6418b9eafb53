"""``python -m surefoot`` is the command line."""

from surefoot.scenarios.cli.program import program

program()
