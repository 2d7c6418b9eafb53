"""Mathematics of the laws: scalars, vectors and rotations, linear algebra, a QP method and convex hulls."""
