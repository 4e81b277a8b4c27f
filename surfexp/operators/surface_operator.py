"""What an operator backend provides: gradient, divergence, mass and stiffness on one surface."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
from scipy.sparse import csr_array

from surfexp.contract.arrays import Floats, Integers
from surfexp.operators.assembly_pattern import AssemblyPattern, assembly_pattern

WITH_GRADIENTS = ("fem", "intrinsic_delaunay", "libigl")


@dataclass(frozen=True, eq=False)
class SurfaceOperator:
    """Piecewise linear functions on triangles, in each face's own orthonormal frame.

    The gradient is constant on a face, G f = sum_k f(face[k]) * hat_gradients[:, k], and the divergence is its exact
    negative adjoint, div p = -M^-1 G^T A p, with M the lumped mass and A the areas. The faces may belong to an intrinsic
    triangulation of the same vertices, so nothing here needs an embedding.

    A Laplacian that is known as a pair of matrices alone (`matrix_operator`) has no hat gradients. It serves whatever works with
    stiffness and mass, and says so where gradients are asked for.

    Parameters
    ----------
    faces : (m, 3) int64
    hats : (m, 3, 2) float64, optional
        Gradients of the three hat functions in the face's frame; none where `matrices` takes their place.
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
    matrices : tuple of two (n, n) csr_array, optional
        Stiffness and mass where they are given and not assembled.
    """

    faces: Integers
    hats: Floats | None
    areas: Floats
    vertex_count: int
    frames: Floats | None = None
    averaged_gradient: tuple[csr_array, csr_array, csr_array] | None = None
    name: str = "fem"
    consistent: bool = True
    metrics: dict[str, float] = field(default_factory=dict)
    notes: tuple[str, ...] = ()
    matrices: tuple[csr_array, csr_array] | None = None

    @property
    def hat_gradients(self) -> Floats:
        """(m, 3, 2) gradients of the three hat functions in the face's frame.

        Raises
        ------
        ValueError
            If the operator is a pair of matrices.
        """
        if self.hats is None:
            raise ValueError(
                f"operator {self.name!r} is a pair of matrices without gradients, for eigenproblems and heat flow; "
                f"gradients are needed here: choose operator {', '.join(WITH_GRADIENTS)}"
            )
        return self.hats

    @cached_property
    def mass(self) -> Floats:
        """(n,) lumped mass: the row sums of the mass matrix."""
        if self.matrices is not None:
            return np.asarray(self.matrices[1].sum(axis=1), dtype=np.float64)
        return np.bincount(self.faces.ravel(), np.repeat(self.areas / 3.0, 3), self.vertex_count).astype(np.float64)

    @cached_property
    def pattern(self) -> AssemblyPattern:
        """Where element matrices are summed; kept, for all matrices of a triangulation share it."""
        return assembly_pattern(self.faces, self.vertex_count)

    @cached_property
    def edge_length(self) -> float:
        """h = sqrt(4 mean(area) / sqrt 3)."""
        return float(np.sqrt(self.areas.mean() * 4.0 / np.sqrt(3.0)))
