"""Finite elements of order 1, 2 and 3 on flat and curved triangles: stiffness and mass of a surface."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Literal

import numpy as np
from scipy.sparse import coo_array, csr_array, diags_array

from surfexp.contract.arrays import Floats, Integers
from surfexp.mesh.triangle_mesh import TriangleMesh
from surfexp.operators.elements_lagrange import LagrangeElement, lagrange_element
from surfexp.operators.elements_nodes import ElementNodes, flat_positions, number_nodes

Mass = Literal["consistent", "lumped", "averaged"]
Boundary = Literal["neumann", "dirichlet"]
Projection = Callable[[Floats], Floats]
FACES_AT_ONCE = 8192


@dataclass(frozen=True, eq=False)
class SurfaceElements:
    """The pencil of the Laplace-Beltrami operator in a finite element space (3.15)-(3.17).

    Parameters
    ----------
    stiffness, mass : (f, f) csr_array
        Over the free nodes: all of them (Neumann), or those off the boundary (Dirichlet).
    nodes : ElementNodes
    free : (f,) int64
        Node number of each row.
    area : float
        Area of the (curved) surface by quadrature.
    metrics, notes
        As in `Surface`.
    """

    stiffness: csr_array
    mass: csr_array
    nodes: ElementNodes
    free: Integers
    area: float
    metrics: dict[str, float] = field(default_factory=dict)
    notes: tuple[str, ...] = ()

    def extend(self, vectors: Floats) -> Floats:
        """Return functions at all nodes, 0 at those that are not free; rows of vertices come first."""
        result = np.zeros((self.nodes.count, *vectors.shape[1:]))
        result[self.free] = vectors
        return result


def surface_elements(
    mesh: TriangleMesh,
    order: int = 1,
    project: Projection | None = None,
    project_boundary: Projection | None = None,
    mass: Mass = "consistent",
    boundary: Boundary = "neumann",
    weight: Floats | None = None,
) -> SurfaceElements:
    """Assemble stiffness int w grad u . grad v and mass int u v.

    On flat facets orders 2 and 3 solve the problem of the polyhedron very well, which is not the smooth surface's: give
    `project` where the smooth shape is known.

    Parameters
    ----------
    mesh : TriangleMesh
    order : 1, 2 or 3
    project : callable, optional
        Takes (k, 3) points near the smooth surface to points on it; moves the nodes that are not vertices.
    project_boundary : callable, optional
        The same for the nodes of boundary sides only, towards a smooth rim.
    mass : "consistent", "lumped" or "averaged"
        The averaged one is the mean of the two; it cancels the leading error of order 1 on good meshes, and gives up that
        eigenvalues are upper bounds. Order 1 only, but for "consistent".
    boundary : "neumann" or "dirichlet"
    weight : (m,) or (n,) float64, optional
        Positive weight w per face or per vertex.

    Raises
    ------
    ValueError
        If an option is unknown or unfit, or the boundary is empty with "dirichlet".
    """
    positions = flat_positions(mesh.vertices[mesh.faces], order if order in (1, 2, 3) else 1)
    nodes = number_nodes(mesh.faces, len(mesh.vertices), lagrange_element(order).order)
    moved = positions[:, 3:]
    if project is not None and moved.size:
        moved[:] = project(moved.reshape(-1, 3)).reshape(moved.shape)
    if project_boundary is not None and moved.size:
        on_rim = np.isin(nodes.connectivity[:, 3 : 3 * order], nodes.boundary)
        on_rim &= np.repeat(_boundary_sides(nodes), order - 1, axis=1)
        sides = moved[:, : 3 * (order - 1)]
        sides[on_rim] = project_boundary(sides[on_rim])
    return assemble_elements(nodes, positions, mass, boundary, weight)


def assemble_elements(
    nodes: ElementNodes,
    positions: Floats,
    mass: Mass = "consistent",
    boundary: Boundary = "neumann",
    weight: Floats | None = None,
) -> SurfaceElements:
    """Assemble the pencil of faces whose nodes lie anywhere, also where the surface has no embedding.

    Parameters
    ----------
    nodes : ElementNodes
    positions : (m, b, d) float64
        Positions of the nodes of each face; those of different faces need not agree (a flat torus, glued tiles).
    mass, boundary, weight
        As in `surface_elements`.
    """
    _check(nodes, mass, boundary)
    element = lagrange_element(nodes.order)
    stiffness_blocks, mass_blocks = [], []
    for first in range(0, len(positions), FACES_AT_ONCE):
        some = slice(first, first + FACES_AT_ONCE)
        at_points = _weight_at_points(element, nodes, some, weight)
        local = _element_matrices(element, positions[some], at_points)
        stiffness_blocks.append(local[0])
        mass_blocks.append(local[1])
    stiffness_matrix = _sum_up(nodes, np.concatenate(stiffness_blocks))
    return pencil_of(nodes, stiffness_matrix, _sum_up(nodes, np.concatenate(mass_blocks)), mass, boundary)


def pencil_of(
    nodes: ElementNodes, stiffness_matrix: csr_array, consistent: csr_array, mass: Mass, boundary: Boundary
) -> SurfaceElements:
    """Make a pencil of two matrices over all nodes: the mass lumped or not, the boundary free or held at 0.

    Parameters
    ----------
    nodes : ElementNodes
    stiffness_matrix, consistent : (n, n) csr_array
    mass, boundary
        As in `surface_elements`.
    """
    _check(nodes, mass, boundary)
    lumped = csr_array(diags_array(consistent.sum(axis=1)))
    chosen = {"consistent": consistent, "lumped": lumped, "averaged": csr_array(0.5 * (consistent + lumped))}[mass]
    free = np.arange(nodes.count)
    if boundary == "dirichlet":
        free = np.setdiff1d(free, nodes.boundary)
        stiffness_matrix, chosen = stiffness_matrix[free][:, free], chosen[free][:, free]
    area = float(consistent.sum())
    return SurfaceElements(
        stiffness_matrix, chosen, nodes, free, area, {"degrees_of_freedom": float(len(free)), "area": area}
    )


def _check(nodes: ElementNodes, mass: str, boundary: str) -> None:
    if mass not in ("consistent", "lumped", "averaged"):
        raise ValueError(f"mass {mass!r} is unknown, choose consistent, lumped or averaged")
    if mass != "consistent" and nodes.order > 1:
        raise ValueError(f"mass {mass!r} with elements of order {nodes.order}: choose consistent, or order 1")
    if boundary not in ("neumann", "dirichlet"):
        raise ValueError(f"boundary {boundary!r} is unknown, choose neumann or dirichlet")
    if boundary == "dirichlet" and not len(nodes.boundary):
        raise ValueError("the surface is closed and has no boundary for dirichlet values: choose neumann")


def _boundary_sides(nodes: ElementNodes) -> np.ndarray:
    """(m, 3) whether each side of a face belongs to no other face: its first inner node is on the boundary."""
    first_on_side = nodes.connectivity[:, 3 : 3 * nodes.order : nodes.order - 1]
    return np.isin(first_on_side, nodes.boundary)


def _weight_at_points(
    element: LagrangeElement, nodes: ElementNodes, some: slice, weight: Floats | None
) -> Floats | float:
    if weight is None:
        return 1.0
    values = np.asarray(weight, dtype=np.float64)
    if not np.isfinite(values).all() or values.min() <= 0:
        raise ValueError(f"the smallest weight is {values.min():g}, weights must be positive and finite")
    if len(values) == len(nodes.connectivity):
        return values[some, None]
    corners = nodes.connectivity[some, :3]
    if len(values) <= corners.max():
        raise ValueError(f"weight has {len(values)} entries, expected one for each face or each vertex")
    x, y = element.points.T
    return values[corners] @ np.stack([1.0 - x - y, x, y])


def _element_matrices(element: LagrangeElement, positions: Floats, weight: Floats | float) -> tuple[Floats, Floats]:
    """(m, b, b) local stiffness and mass: S^T S with the gradients in an orthonormal frame at every quadrature point."""
    jacobians = np.einsum("mbd,qbk->mqkd", positions, element.gradients, optimize=True)
    first = jacobians[:, :, 0]
    lengths = np.linalg.norm(first, axis=2)
    with np.errstate(invalid="ignore", divide="ignore"):
        along = np.einsum("mqd,mqd->mq", first, jacobians[:, :, 1]) / lengths
        shear = along / lengths
    heights = np.linalg.norm(jacobians[:, :, 1] - shear[..., None] * first, axis=2)
    measure = element.weights * lengths * heights
    if not np.isfinite(measure).all() or measure.min() <= 0:
        raise ValueError(f"face {int(np.argmin(measure.min(axis=1)))} has no area: repair the mesh")
    slope_x = element.gradients[None, :, :, 0] / lengths[:, :, None]
    slope_y = (element.gradients[None, :, :, 1] - along[:, :, None] * slope_x) / heights[:, :, None]
    roots = np.sqrt(measure * weight)[:, :, None]
    slopes = np.concatenate([roots * slope_x, roots * slope_y], axis=1)
    values = np.sqrt(measure)[:, :, None] * element.basis
    return np.matmul(slopes.transpose(0, 2, 1), slopes), np.matmul(values.transpose(0, 2, 1), values)


def _sum_up(nodes: ElementNodes, local: Floats) -> csr_array:
    width = nodes.connectivity.shape[1]
    rows = np.repeat(nodes.connectivity, width, axis=1).ravel()
    columns = np.tile(nodes.connectivity, (1, width)).ravel()
    summed = csr_array(coo_array((local.ravel(), (rows, columns)), shape=(nodes.count, nodes.count)))
    return csr_array(0.5 * (summed + summed.T))
