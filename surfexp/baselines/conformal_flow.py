"""Conformalised mean curvature flow of a closed genus-0 surface to the sphere."""

from __future__ import annotations

import numpy as np
from scipy.sparse import csr_array

from surfexp.baselines.moebius import centred
from surfexp.baselines.spherical_map import check_sphere
from surfexp.contract.arrays import Floats
from surfexp.linalg.ldlt import ldlt
from surfexp.mesh.triangle_mesh import TriangleMesh
from surfexp.operators.assembly import mass_matrix, stiffness
from surfexp.operators.fem import fem
from surfexp.variational.fidelity import Progress

ROUNDNESS = 0.1
DEFECT_FLOOR = 1e-7


def conformal_flow(
    mesh: TriangleMesh,
    positions: Floats | None = None,
    time_step: float = 0.1,
    tolerance: float = 1e-3,
    step_limit: int = 100,
    progress: Progress | None = None,
) -> Floats:
    """Let a surface flow to the round sphere with the stiffness of the start and the mass of the moment.

    (M_t + s Q) x_{t+1} = M_t x_t, centred and rescaled to the area of the unit sphere after each step (Kazhdan, Solomon
    and Ben-Chen 2012). It ends when the surface is round and its conformality defect, Dirichlet energy / area - 1,
    changes by less than `tolerance` times itself in a step; a Moebius transformation then centres the areas.

    Parameters
    ----------
    mesh : TriangleMesh
        Whose angles are to be kept.
    positions : (n, 3) float64, optional
        Where the flow starts: the mesh itself, or a map that `spherical_map` has made and the flow improves.
    time_step : float
        s, where the moving surface has the area of the unit sphere.
    tolerance : float
    step_limit : int
    progress : callable, optional
        Called with the step and the conformality defect.

    Returns
    -------
    (n, 3) float64
        Points on the unit sphere.

    Raises
    ------
    ValueError
        If the mesh is not one closed surface of genus 0.
    """
    check_sphere(mesh)
    matrix = stiffness(fem(mesh))
    points = _rescaled(mesh, mesh.vertices if positions is None else positions)
    defect = _defect(matrix, mesh, points)
    for step in range(1, step_limit + 1):
        mass = mass_matrix(fem(TriangleMesh(points, mesh.faces)))
        points = _rescaled(mesh, ldlt(mass + time_step * matrix).solve(mass @ points))
        before, defect = defect, _defect(matrix, mesh, points)
        if progress is not None:
            progress(step, defect)
        radii = np.linalg.norm(points, axis=1)
        if np.ptp(radii) <= ROUNDNESS and abs(before - defect) <= max(tolerance * defect, DEFECT_FLOOR):
            break
    return centred(points / np.linalg.norm(points, axis=1, keepdims=True), mesh.vertex_areas)


def _defect(matrix: csr_array, mesh: TriangleMesh, positions: Floats) -> float:
    energy = 0.5 * float(np.einsum("nd,nd->", positions, matrix @ positions))
    return energy / TriangleMesh(positions, mesh.faces).area - 1.0


def _rescaled(mesh: TriangleMesh, positions: Floats) -> Floats:
    """Centre at the area-weighted mean and scale to the area of the unit sphere."""
    moved = TriangleMesh(positions, mesh.faces)
    centre = moved.vertex_areas @ positions / moved.area
    return (positions - centre) * np.sqrt(4.0 * np.pi / moved.area)
