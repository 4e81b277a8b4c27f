"""The gradient and divergence that a scheme uses: the face-based adjoint pair, or the published one."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from surfexp.contract.arrays import Floats
from surfexp.operators.calculus import divergence, gradient
from surfexp.operators.surface_operator import SurfaceOperator


@dataclass(frozen=True, eq=False)
class VectorPair:
    """Gradient and divergence of scalar functions.

    With a vertex-averaged operator these are W f, (n, 3), and W . V of (1.27), which are not adjoint; otherwise G f, (m, 2),
    and its exact negative adjoint.

    Parameters
    ----------
    operator : SurfaceOperator
    """

    operator: SurfaceOperator

    @property
    def field_shape(self) -> tuple[int, int]:
        """Shape of a vector field."""
        if self.operator.averaged_gradient is None:
            return len(self.operator.faces), 2
        return self.operator.vertex_count, 3

    def gradient(self, values: Floats) -> Floats:
        """Return the gradient of (n,) values."""
        rows = self.operator.averaged_gradient
        if rows is None:
            return gradient(self.operator, values)
        return np.stack([row @ values for row in rows], axis=1)

    def divergence(self, field: Floats) -> Floats:
        """Return the divergence at the vertices."""
        rows = self.operator.averaged_gradient
        if rows is None:
            return divergence(self.operator, field)
        result: Floats = sum(row @ field[:, x] for x, row in enumerate(rows))
        return result

    def squared_norm(self, iterations: int = 50) -> float:
        """Return an estimate, 5 % above a power iteration, of the largest eigenvalue of -div grad in size."""
        values = np.cos(1.0 + np.arange(self.operator.vertex_count) ** 2.0)
        length = 0.0
        for _ in range(iterations):
            values /= np.sqrt(self.operator.mass @ values**2)
            values = -self.divergence(self.gradient(values))
            length = float(np.sqrt(self.operator.mass @ values**2))
        return 1.05 * length


def shrink(field: Floats, radius: float) -> Floats:
    """Return the field with every vector shortened by `radius`, (2.17)."""
    lengths = np.linalg.norm(field, axis=1, keepdims=True)
    return field * np.maximum(1.0 - radius / np.maximum(lengths, radius), 0.0)


def project_to_ball(field: Floats) -> Floats:
    """Return the field with every vector longer than 1 cut to length 1."""
    return field / np.maximum(np.linalg.norm(field, axis=1, keepdims=True), 1.0)
