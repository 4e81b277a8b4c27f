"""Seconds and memory of each kernel against the number of vertices, each in a process of its own."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

import numpy as np

from audits.benchmarks.line import Line
from audits.benchmarks.measurement import Cost, apart, measure, peak_memory
from audits.benchmarks.scenes import Scene, torus_scene
from surfexp.mesh.triangle_mesh import TriangleMesh
from surfexp.operators.assembly import mass_matrix, stiffness
from surfexp.operators.fem import fem
from surfexp.skeleton.exact_reeb_graph import exact_reeb_graph
from surfexp.skeleton.fast_marching import fast_marching
from surfexp.spectrum.eigensolver import eigenpairs
from surfexp.spectrum.nodal_domains import nodal_counts
from surfexp.spectrum.nodal_graph import nodal_graph
from surfexp.variational.models.rof import ROF
from surfexp.variational.solvers.newton import newton
from surfexp.variational.solvers.primal_dual import primal_dual

SIDES = (100, 200, 400, 800)
EXPONENT = 1.15
Work = Callable[[], object]


def warm_up() -> None:
    """Nothing is measured in this process."""


def lines(quick: bool) -> list[Line]:
    """Return a line of growth for each kernel."""
    return [_line(name, SIDES[:2] if quick else SIDES) for name in KERNELS]


def _line(name: str, sides: tuple[int, ...]) -> Line:
    counts, costs, peaks = zip(*(apart(_measured, name, side) for side in sides), strict=True)
    seconds = np.array([cost.cpu for cost in costs])
    exponent = float(np.polyfit(np.log(counts), np.log(seconds), 1)[0])
    told = ", ".join(f"{n:,} V {t:.3g} s" for n, t in zip(counts, seconds, strict=True))
    memory = f"{max(peaks[-1], 0.0) / counts[-1]:,.0f} bytes a vertex"
    return Line(
        f"{name}, torus of {counts[0]:,} to {counts[-1]:,} V",
        "its own growth",
        f"exponent ≤ {EXPONENT:g}",
        f"exponent {exponent:.2f}, {memory}",
        exponent <= EXPONENT,
        costs[-1],
        accuracy=told,
        note="memory: growth of the peak at the largest size, mesh and picture included",
        points=tuple(zip(map(float, counts), map(float, seconds), strict=True)),
        curve=name,
    )


def _measured(name: str, side: int) -> tuple[int, Cost, float]:
    prepare = KERNELS[name]
    prepare(torus_scene(SIDES[0]))()  # compiles
    before = peak_memory()
    scene = torus_scene(side)
    work = prepare(scene)
    _, cost = measure(work)
    return len(scene.surface.mesh.vertices), cost, peak_memory() - before


def _assembly(scene: Scene) -> Work:
    vertices, faces = scene.surface.mesh.vertices, scene.surface.mesh.faces

    def work() -> object:
        operator = fem(TriangleMesh(vertices, faces))
        return stiffness(operator), mass_matrix(operator)

    return work


def _eigenpairs(scene: Scene) -> Work:
    operator = fem(scene.surface.mesh)
    return partial(eigenpairs, stiffness(operator), mass_matrix(operator), 50)


def _nodal(scene: Scene) -> Work:
    mesh = scene.surface.mesh
    graph = nodal_graph(mesh.faces, len(mesh.vertices))
    waves = np.arange(1.0, 21.0) * np.pi / np.ptp(mesh.vertices[:, 0])
    return partial(nodal_counts, graph, np.asfortranarray(np.sin(mesh.vertices[:, :1] * waves)))


def _reeb(scene: Scene) -> Work:
    mesh = scene.surface.mesh
    return partial(exact_reeb_graph, mesh, mesh.vertices[:, 2])


def _marching(scene: Scene) -> Work:
    mesh = scene.surface.mesh
    return lambda: fast_marching(TriangleMesh(mesh.vertices, mesh.faces), np.array([0]))


def _newton(scene: Scene) -> Work:
    return partial(ROF().run, scene.image, fem(scene.surface.mesh), partial(newton, tolerance=1e-6))


def _primal_dual(scene: Scene) -> Work:
    method = partial(primal_dual, tolerance=-1.0, iteration_limit=100)
    return partial(ROF().run, scene.image, fem(scene.surface.mesh), method)


KERNELS: dict[str, Callable[[Scene], Work]] = {
    "stiffness and mass": _assembly,
    "first 50 eigenpairs": _eigenpairs,
    "nodal domains of 20 functions": _nodal,
    "exact Reeb graph": _reeb,
    "fast marching from a point": _marching,
    "ROF to 1e-6, Newton": _newton,
    "ROF, 100 primal-dual steps": _primal_dual,
}
