"""Stiffness and consistent mass of linear elements, against libigl."""

from __future__ import annotations

import igl
import numpy as np
from scipy.sparse import sparray

from benchmarks.line import Line, race
from benchmarks.measurement import measure
from benchmarks.scenes import cortex_scene
from surfexp.mesh.icosphere import icosphere
from surfexp.mesh.triangle_mesh import TriangleMesh
from surfexp.operators.assembly import mass_matrix, stiffness
from surfexp.operators.fem import fem


def warm_up() -> None:
    """Compile what the line uses."""
    _ours(icosphere(2).mesh)


def lines(quick: bool) -> list[Line]:
    """Return the line of the folded cortex."""
    mesh = cortex_scene(10000 if quick else 39994).surface.mesh
    ours, cost = measure(lambda: _ours(mesh), runs=9)
    theirs, their_cost = measure(lambda: _libigl(mesh), runs=9)
    difference = max(
        float(np.abs((a - b).data).max() / np.abs(b.data).max()) for a, b in zip(ours, theirs, strict=True)
    )
    accuracy = f"matrices equal to {difference:.0e}; {1e9 * cost.cpu / len(mesh.faces):.0f} and "
    accuracy += f"{1e9 * their_cost.cpu / len(mesh.faces):.0f} ns a face"
    work = f"P1 stiffness and mass, {len(mesh.vertices):,} V, from the mesh"
    return [race(work, "libigl", 4, cost, their_cost, accuracy, fair=difference < 1e-9)]


def _ours(mesh: TriangleMesh) -> tuple[sparray, sparray]:
    operator = fem(mesh)
    return stiffness(operator), mass_matrix(operator)


def _libigl(mesh: TriangleMesh) -> tuple[sparray, sparray]:
    vertices, faces = mesh.vertices, mesh.faces
    return -igl.cotmatrix(vertices, faces), igl.massmatrix(vertices, faces, igl.MASSMATRIX_TYPE_FULL)
