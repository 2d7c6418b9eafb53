"""The MCAP log: channels, writer, reader and recovery."""
