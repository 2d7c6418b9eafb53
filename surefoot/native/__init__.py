"""The modules that are compiled, and the kernels in C that are yet to become such modules."""
