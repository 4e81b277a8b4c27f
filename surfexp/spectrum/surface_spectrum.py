"""The spectrum of a surface: elements of an order on it, and their first eigenpairs."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from surfexp.contract.arrays import Floats, Integers
from surfexp.mesh.surface import Surface
from surfexp.operators.elements_nodes import flat_positions, number_nodes
from surfexp.operators.elements_patches import patch_positions
from surfexp.operators.elements_surface import (
    Boundary,
    Mass,
    SurfaceElements,
    assemble_elements,
    pencil_of,
    surface_elements,
)
from surfexp.operators.surface_operator import SurfaceOperator
from surfexp.spectrum.eigensolver import eigenpairs
from surfexp.spectrum.eigensystem import EigenSystem
from surfexp.spectrum.nodal_graph import NodalGraph, element_faces, nodal_graph
from surfexp.spectrum.single_slice import Progress

LARGEST_BAD_ANGLE = 1.0


def elements_of(
    surface: Surface,
    operator: SurfaceOperator,
    order: int = 1,
    curved: bool = False,
    mass: Mass = "consistent",
    boundary: Boundary = "neumann",
    patches: bool = False,
) -> SurfaceElements:
    """Assemble elements on the triangles of an operator, or on the smooth surface that the mesh stands for.

    Parameters
    ----------
    surface : Surface
    operator : SurfaceOperator
        Its triangles may be intrinsic; then order 1 only. So with a pair of matrices, which is taken as it is.
    order : 1, 2 or 3
    curved : bool
        Put the new nodes of order 2 and 3 on the smooth shape of the surface, where it has one.
    patches : bool
        Put them on cubic patches through the vertices, for a mesh whose smooth shape nobody knows.

    Raises
    ------
    ValueError
        If the order or the shape is unfit.
    """
    if curved and patches:
        raise ValueError("curved and patches are two ways to place the same nodes: choose one")
    if operator.matrices is not None:
        if order > 1:
            raise ValueError(
                f"elements of order {order} of operator {operator.name!r}, a pair of matrices: choose order 1"
            )
        return pencil_of(number_nodes(operator.faces, operator.vertex_count, 1), *operator.matrices, mass, boundary)
    if curved:
        if surface.shape is None:
            raise ValueError(
                f"the smooth shape of {surface.name!r} is unknown: choose curved=false, or patches=true for cubic patches"
            )
        shape = surface.shape
        return surface_elements(surface.mesh, order, shape.project, shape.project_boundary, mass, boundary)
    if order > 1 and not np.array_equal(operator.faces, surface.mesh.faces):
        raise ValueError(
            f"elements of order {order} on the triangles of operator {operator.name!r}: choose fem, or order 1"
        )
    nodes = number_nodes(operator.faces, operator.vertex_count, order)
    if patches:
        return assemble_elements(nodes, patch_positions(surface.mesh, order), mass, boundary)
    return assemble_elements(nodes, flat_positions(unfolded_corners(operator), order), mass, boundary)


def unfolded_corners(operator: SurfaceOperator) -> Floats:
    """(m, 3, 2) corners of every triangle in the plane of its frame, the first at the origin."""
    sides = np.linalg.inv(operator.hat_gradients[:, 1:])
    return np.stack([np.zeros_like(sides[:, :, 0]), sides[:, :, 0], sides[:, :, 1]], axis=1)


def surface_spectrum(
    surface: Surface,
    operator: SurfaceOperator,
    count: int,
    method: str = "auto",
    order: int = 1,
    curved: bool = False,
    mass: Mass = "consistent",
    boundary: Boundary = "neumann",
    tolerance: float = 1e-8,
    seed: int = 0,
    progress: Progress | None = None,
    patches: bool = False,
    threads: int = 1,
) -> EigenSystem:
    """Find the first pairs of a surface, as functions at all nodes: 0 on the rim under Dirichlet's condition.

    Parameters
    ----------
    surface, operator, order, curved, mass, boundary, patches
        As in `elements_of`.
    count, method, tolerance, seed, progress, threads
        As in `eigenpairs`.

    Returns
    -------
    EigenSystem
        With the metrics degrees_of_freedom, edge_length, largest_residual, orthogonality, complete (1 or 0), zero_modes,
        first_value and last_value.
    """
    elements = elements_of(surface, operator, order, curved, mass, boundary, patches)
    system = eigenpairs(elements.stiffness, elements.mass, count, method, tolerance, seed, progress, threads)
    scale = float(system.values[-1])
    metrics = {
        **elements.metrics,
        "edge_length": operator.edge_length,
        "largest_residual": float(system.residuals.max()),
        "orthogonality": system.orthogonality,
        "complete": float(system.complete),
        "zero_modes": float((np.abs(system.values) <= 1e-8 * max(scale, 1e-300)).sum()) if count > 1 else 0.0,
        "first_value": float(system.values[min(1, count - 1) if boundary == "neumann" else 0]),
        "last_value": scale,
        "clusters": float(len(system.clusters)),
    }
    notes = list(system.notes)
    pieces = surface.mesh.component_count
    if pieces > 1:
        notes.append(f"The surface has {pieces} components, each with a zero mode of its own.")
    if surface.mesh.minimum_angle < LARGEST_BAD_ANGLE and operator.name == "fem":
        notes.append(
            f"The smallest angle is {surface.mesh.minimum_angle:.2g} degrees, linear elements lose accuracy there: an experiment "
            "with operator=intrinsic_delaunay shows how much."
        )
    return replace(
        system,
        vectors=np.asfortranarray(elements.extend(system.vectors)),
        area=elements.area,
        order=order,
        boundary=boundary,
        metrics={**metrics, **system.metrics},
        notes=tuple(notes),
    )


def graph_of(operator: SurfaceOperator, system: EigenSystem) -> NodalGraph:
    """Return the graph over the nodes of a spectrum, for nodal domains."""
    nodes = number_nodes(operator.faces, operator.vertex_count, system.order)
    faces: Integers = element_faces(nodes)
    return nodal_graph(faces, nodes.count)
