"""Skeletons of surfaces: feature functions, level sets, Reeb graphs, flux and the Hamilton-Jacobi skeleton (chapter 5)."""
