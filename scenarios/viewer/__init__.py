"""What MCAP viewers draw: a run in Foxglove's well-known schemas, beside the numeric channels of the log."""
