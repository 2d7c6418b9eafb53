"""``python -m surefoot`` is the command line."""

from surefoot.scenarios.cli import main

main()
