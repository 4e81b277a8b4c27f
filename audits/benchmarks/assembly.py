"""Stiffness and consistent mass of linear elements, against libigl and LaPy."""

from __future__ import annotations

from collections.abc import Callable
from importlib.util import find_spec

import igl
import numpy as np
from scipy.sparse import sparray

from audits.benchmarks.line import Line, not_installed, race
from audits.benchmarks.measurement import measure_both
from audits.benchmarks.scenes import cortex_scene
from surfexp.mesh.shapes.icosphere import icosphere
from surfexp.mesh.triangle_mesh import TriangleMesh
from surfexp.operators.assembly import mass_matrix, stiffness
from surfexp.operators.fem import fem

LEAST = 5.0
NOTE = "both from arrays of vertices and faces; what the rival prepares of its mesh is not counted"


def warm_up() -> None:
    """Compile what the line uses."""
    _ours(icosphere(2).mesh)


def lines(quick: bool) -> list[Line]:
    """Return the lines of the folded cortex."""
    mesh = cortex_scene(10000 if quick else 39994).surface.mesh
    work = f"P1 stiffness and mass, {len(mesh.vertices):,} V, from the mesh"
    found = [_line(work, mesh, "libigl", lambda: _libigl(mesh))]
    if find_spec("lapy") is None:
        return [*found, not_installed(work, "LaPy", LEAST, "lapy")]
    from lapy import Solver, TriaMesh

    given = TriaMesh(mesh.vertices, mesh.faces)

    def lapy() -> tuple[sparray, sparray]:
        solver = Solver(given)
        return solver.stiffness, solver.mass

    return [*found, _line(work, mesh, "LaPy", lapy)]


def _line(work: str, mesh: TriangleMesh, rival: str, solve: Callable[[], tuple[sparray, sparray]]) -> Line:
    (ours, cost), (theirs, their_cost) = measure_both(lambda: _ours(mesh), solve, runs=9)
    difference = max(
        float(np.abs((a - b).data).max() / np.abs(b.data).max()) for a, b in zip(ours, theirs, strict=True)
    )
    accuracy = f"matrices equal to {difference:.0e}; {1e9 * cost.cpu / len(mesh.faces):.0f} and "
    accuracy += f"{1e9 * their_cost.cpu / len(mesh.faces):.0f} ns a face"
    return race(work, rival, LEAST, cost, their_cost, accuracy, fair=difference < 1e-9, note=NOTE)


def _ours(mesh: TriangleMesh) -> tuple[sparray, sparray]:
    # a mesh of its own, which has nothing cached
    operator = fem(TriangleMesh(mesh.vertices, mesh.faces))
    return stiffness(operator), mass_matrix(operator)


def _libigl(mesh: TriangleMesh) -> tuple[sparray, sparray]:
    vertices, faces = mesh.vertices, mesh.faces
    return -igl.cotmatrix(vertices, faces), igl.massmatrix(vertices, faces, igl.MASSMATRIX_TYPE_FULL)
