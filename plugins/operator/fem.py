"""Per-face gradients with their exact adjoint."""

from surfexp.lab.registry.registry import register
from surfexp.operators.fem import fem

register(
    "operator",
    "fem",
    summary="Piecewise linear finite elements: gradient on faces, divergence its exact negative adjoint.",
    options={},
)(fem)
