"""Tests at every vertex of a surface: permutations, clusters, threshold-free enhancement, corrections for many tests."""
