"""Studies of many runs: campaigns, the paper, the tour."""
