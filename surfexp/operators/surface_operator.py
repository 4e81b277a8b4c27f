"""What an operator backend provides: gradient, divergence, mass and stiffness on one surface."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
from scipy.sparse import csr_array

from surfexp.arrays import Floats, Integers
from surfexp.operators.assembly_pattern import AssemblyPattern, assembly_pattern


@dataclass(frozen=True, eq=False)
class SurfaceOperator:
    """Piecewise linear functions on triangles, in each face's own orthonormal frame.

    The gradient is constant on a face, G f = sum_k f(face[k]) * hat_gradients[:, k], and the divergence is its exact
    negative adjoint, div p = -M^-1 G^T A p, with M the lumped mass and A the areas. The faces may belong to an intrinsic
    triangulation of the same vertices, so nothing here needs an embedding.

    Parameters
    ----------
    faces : (m, 3) int64
    hat_gradients : (m, 3, 2) float64
        Gradients of the three hat functions in the face's frame.
    areas : (m,) float64
    vertex_count : int
    frames : (m, 2, 3) float64, optional
        The frame vectors in space, when the faces are those of the mesh.
    averaged_gradient : tuple of three (n, n) csr_array, optional
        The published vertex-averaged gradient W of (1.26), one matrix for each coordinate. A solver that finds it uses
        W and W* in place of the face gradient and its adjoint (and so minimises no energy: audit it under this one).
    name : str
    consistent : bool
        Whether the divergence a solver uses is the adjoint of its gradient, so that an energy gap exists.
    metrics, notes
        As in `Surface`.
    """

    faces: Integers
    hat_gradients: Floats
    areas: Floats
    vertex_count: int
    frames: Floats | None = None
    averaged_gradient: tuple[csr_array, csr_array, csr_array] | None = None
    name: str = "fem"
    consistent: bool = True
    metrics: dict[str, float] = field(default_factory=dict)
    notes: tuple[str, ...] = ()

    @cached_property
    def mass(self) -> Floats:
        """(n,) lumped mass."""
        return np.bincount(self.faces.ravel(), np.repeat(self.areas / 3.0, 3), self.vertex_count).astype(np.float64)

    @cached_property
    def pattern(self) -> AssemblyPattern:
        """Where element matrices are summed; kept, for all matrices of a triangulation share it."""
        return assembly_pattern(self.faces, self.vertex_count)

    @cached_property
    def edge_length(self) -> float:
        """h = sqrt(4 mean(area) / sqrt 3)."""
        return float(np.sqrt(self.areas.mean() * 4.0 / np.sqrt(3.0)))
