"""Solving a surface problem on a domain to which the surface was mapped, with the conformal factor as weights."""

from __future__ import annotations

from dataclasses import dataclass, field, replace

import numpy as np
from scipy.sparse import csr_array, eye_array

from surfexp.baselines.data_term_transfer import transported
from surfexp.contract.arrays import Floats
from surfexp.mesh.triangle_mesh import TriangleMesh
from surfexp.operators.calculus import total_variation
from surfexp.operators.fem import fem
from surfexp.operators.surface_operator import SurfaceOperator
from surfexp.variational.duality_gap import recertify
from surfexp.variational.fidelity import Method
from surfexp.variational.separable_quadratic import SeparableQuadratic
from surfexp.variational.solution import Solution


@dataclass(frozen=True, eq=False)
class ParameterDomain:
    """A domain that stands for a surface, and the way there and back.

    Parameters
    ----------
    operator : SurfaceOperator
        Of the domain, with the metric of the surface as `conformal_operator` makes it.
    to_domain : (k, n) csr_array
        Interpolates values at the vertices to the points of the domain.
    to_vertices : (n, k) csr_array
        Interpolates back.
    keeps_faces : bool
        Whether the faces of the domain are those of the mesh, in the same order, so that a dual field on the domain,
        given in frames along the first sides, is one on the surface.
    name : str
    metrics : dict of str to float
    """

    operator: SurfaceOperator
    to_domain: csr_array
    to_vertices: csr_array
    keeps_faces: bool = True
    name: str = "conformal"
    metrics: dict[str, float] = field(default_factory=dict)

    @property
    def memory(self) -> int:
        """Bytes of the operator and the two interpolations."""
        matrices = (self.to_domain, self.to_vertices)
        sparse = sum(m.data.nbytes + m.indices.nbytes + m.indptr.nbytes for m in matrices)
        return sparse + sum(a.nbytes for a in (self.operator.faces, self.operator.hat_gradients, self.operator.areas))


@dataclass(frozen=True, eq=False)
class Parametrized:
    """A method for convex models that solves them on a parameter domain with an intrinsic method.

    Parameters
    ----------
    domain : ParameterDomain
    method : Method
        Solves on the domain.
    """

    domain: ParameterDomain
    method: Method

    def __call__(
        self, fidelity: SeparableQuadratic, operator: SurfaceOperator, start: Solution | None = None
    ) -> Solution:
        """Solve on the domain and interpolate to the vertices, then measure the result on the surface.

        `start` is an earlier solution at the vertices. Where the domain keeps the faces, the dual field of the domain
        is feasible on the surface too and certifies the energy there; else there is no certificate. `domain_energy` and
        `domain_gap` among the metrics are those of the solver.
        """
        domain = self.domain
        problem = transported(fidelity, domain.operator.mass, lambda values: domain.to_domain @ values)
        first = None if start is None else replace(start, values=domain.to_domain @ start.values)
        there = self.method(problem, domain.operator, first)
        values = np.clip(domain.to_vertices @ there.values, fidelity.lower, fidelity.upper)
        energy = total_variation(operator, values) + fidelity.value(values)
        metrics = {
            "energy": energy,
            "iterations": float(there.iterations),
            "domain_energy": there.energy,
            "node_count": float(domain.operator.vertex_count),
            "memory_bytes": float(domain.memory),
        }
        if there.relative_gap is not None:
            metrics["domain_gap"] = there.relative_gap
        solution = Solution(
            values=values,
            energy=energy,
            dual=there.dual if domain.keeps_faces else None,
            iterations=there.iterations,
            converged=there.converged,
            reason=there.reason + " on the parameter domain",
            history=there.history,
            model=fidelity.name,
            solver=f"{domain.name} {there.solver}",
            metrics=domain.metrics | metrics,
            notes=("solved on a parameter domain; energy and certificate are those on the surface",),
        )
        return solution if solution.dual is None else recertify(solution, fidelity, operator)


def conformal_operator(mesh: TriangleMesh, image: TriangleMesh) -> SurfaceOperator:
    """Return the operator of the image of a surface with the lengths of the surface, as far as the map is conformal.

    Areas are those A of the surface and gradients those of the image times the length scale sqrt(A_image / A) of the
    face, so that the total variation is sum_T sqrt(A A_image) |G_image f|, the conformal factor as weights.

    Parameters
    ----------
    mesh, image : TriangleMesh
        With the same faces.

    Raises
    ------
    ValueError
        If a face has no area in one of them.
    """
    there = fem(image)
    return reweighted(there, fem(mesh).areas)


def reweighted(operator: SurfaceOperator, areas: Floats) -> SurfaceOperator:
    """Return the operator in the conformally changed metric in which its faces have the given areas."""
    scale = np.sqrt(operator.areas / areas)
    return SurfaceOperator(
        operator.faces,
        np.ascontiguousarray(operator.hat_gradients * scale[:, None, None]),
        areas,
        operator.vertex_count,
        name="conformal",
    )


def conformal_domain(mesh: TriangleMesh, positions: Floats) -> ParameterDomain:
    """Return the image of a surface under a conformal map, vertex by vertex, as parameter domain.

    Parameters
    ----------
    mesh : TriangleMesh
    positions : (n, 3) or (n, 2) float64
        Image of each vertex, as `spherical_map`, `conformal_flow` or `disk_map` gives it.
    """
    identity = csr_array(eye_array(len(mesh.vertices)))
    return ParameterDomain(conformal_operator(mesh, image_mesh(mesh, positions)), identity, identity)


def image_mesh(mesh: TriangleMesh, positions: Floats) -> TriangleMesh:
    """Return the faces of a mesh over other positions; those in the plane get z = 0."""
    flat = np.zeros((len(positions), 3 - positions.shape[1]))
    return TriangleMesh(np.hstack([positions, flat]), mesh.faces)
