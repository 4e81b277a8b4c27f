"""The tufted Laplacian of Sharp and Crane, a pair of matrices."""

from pydantic import Field

from surfexp.lab.registry.registry import register
from surfexp.operators.matrix_operator import robust_laplacian

register(
    "operator",
    "robust_laplacian",
    summary="Intrinsic Delaunay on a tufted cover, for meshes of any quality: eigenproblems and heat flow, no gradients.",
    options={"mollify": Field(ge=0, lt=1, description="smallest slack of a triangle, over the mean edge length")},
)(robust_laplacian)
