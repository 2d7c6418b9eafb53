"""The tour of a public benchmark of G1 walkers, made anew from its description."""
