"""``python -m surefoot`` is the command line."""

from surefoot.scenarios.apps.cli import program

program()
