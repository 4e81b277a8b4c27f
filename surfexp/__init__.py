"""Intrinsic surface processing on triangle meshes: numerics, and a workflow that compares methods."""
