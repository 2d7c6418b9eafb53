"""What many runs say together: campaigns, checks against baselines, the paper."""
