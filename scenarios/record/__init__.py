"""The rows that a running loop writes into the log's channels."""
