"""Many runs: what they are, who makes them, and the journal that keeps what became of each."""
