"""The whole-body QP as numbers: its data, its solvers, and joints that it does not drive."""
