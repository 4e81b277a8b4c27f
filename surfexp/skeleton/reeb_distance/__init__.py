"""Bounds on the distance of two Reeb graphs: diagrams and merge trees from below, a common space from above."""
