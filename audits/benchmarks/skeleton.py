"""Reeb graphs against VTK, fast marching against potpourri3d, and whole skeletons against seconds."""

from __future__ import annotations

import importlib
from typing import Any

import numpy as np

from audits.benchmarks.line import Line, not_installed, race, within
from audits.benchmarks.measurement import measure, measure_both
from audits.benchmarks.scenes import cortex_scene
from surfexp.contract.arrays import Floats, Integers
from surfexp.mesh.shapes.genus_surface import genus_surface
from surfexp.mesh.shapes.icosphere import icosphere
from surfexp.mesh.triangle_mesh import TriangleMesh
from surfexp.skeleton.exact_reeb_graph import ReebGraph, exact_reeb_graph
from surfexp.skeleton.fast_marching import fast_marching
from surfexp.skeleton.level_selection import choose_levels
from surfexp.skeleton.reeb_graph import reeb_graph
from surfexp.skeleton.simplification import simplified
from surfexp_studies.skeletons.callosum import callosum
from surfexp_studies.skeletons.skeleton_study import eigenmap_skeleton


def warm_up() -> None:
    """Compile what the lines use."""
    mesh = icosphere(2).mesh
    exact_reeb_graph(mesh, mesh.vertices[:, 0])
    fast_marching(mesh, np.array([0]))
    eigenmap_skeleton(callosum(0, edge_length=1.0).mesh)


def lines(quick: bool) -> list[Line]:
    """Return the lines of fast marching, of Reeb graphs, and of whole skeletons."""
    sizes = (10000,) if quick else (10000, 40000, 160000)
    found = [_marching(size) for size in sizes]
    found.append(_exact_graph(10000 if quick else 39994))
    found.append(_sampled_graph(10000 if quick else 160000))
    found.append(_crossings(10000 if quick else 160000))
    return [*found, _patch(0.6, 0.15), *([] if quick else [_patch(0.19, 1.5)])]


def _marching(size: int) -> Line:
    mesh = cortex_scene(size).surface.mesh
    work, rival = f"fast marching from a level set, folded, {len(mesh.vertices):,} V", "potpourri3d fast marching"
    height = mesh.vertices[:, 2]
    sources = np.flatnonzero(np.abs(height - np.median(height)) < 0.004 * np.ptp(height))
    module = _module("potpourri3d")
    if module is None:
        return not_installed(work, rival, 3, "potpourri3d")
    curves: list[list[tuple[int, list[float]]]] = [[(int(i), [])] for i in sources]

    def potpourri() -> Floats:
        return np.ravel(module.MeshFastMarchingDistanceSolver(mesh.vertices, mesh.faces).compute_distance(curves))

    def own() -> Floats:
        return fast_marching(TriangleMesh(mesh.vertices, mesh.faces), sources)

    (ours, cost), (theirs, their_cost) = measure_both(own, potpourri, 5)
    solver = module.MeshFastMarchingDistanceSolver(mesh.vertices, mesh.faces)
    alone = measure(lambda: solver.compute_distance(curves), 5)[1].cpu
    note = f"both from arrays of vertices and faces; the rival with its set-up made before takes {alone:.3g} s"
    exact = _exact_distance(mesh, sources) if size <= 20000 else None
    if exact is None:
        gap = float(np.abs(ours - theirs).max() / mesh.edge_length)
        return race(work, rival, 3, cost, their_cost, f"largest difference {gap:.2f} h", fair=gap < 2.0, note=note)
    error, their_error = (float(np.abs(found - exact).mean() / mesh.edge_length) for found in (ours, theirs))
    accuracy = f"mean error against exact distances {error:.3f} h, rival {their_error:.3f} h"
    return race(work, rival, 3, cost, their_cost, accuracy, fair=error <= 1.001 * their_error, note=note)


def _exact_distance(mesh: TriangleMesh, sources: Integers) -> Floats | None:
    module = _module("pygeodesic.geodesic")
    if module is None:
        return None
    algorithm = module.PyGeodesicAlgorithmExact(mesh.vertices, mesh.faces.astype(np.int32))
    return np.asarray(algorithm.geodesicDistances(sources.astype(np.int32), None)[0], dtype=np.float64)


def _exact_graph(size: int) -> Line:
    mesh = cortex_scene(size).surface.mesh
    work, rival = f"exact Reeb graph, all critical points, folded, {len(mesh.vertices):,} V", "vtkReebGraph"
    height = mesh.vertices[:, 2].copy()
    module = _module("vtk")
    if module is None:
        return not_installed(work, rival, 77, "vtk")
    (ours, cost), (theirs, their_cost) = measure_both(
        lambda: exact_reeb_graph(TriangleMesh(mesh.vertices, mesh.faces), height), lambda: _vtk(module, mesh, height)
    )
    same = _like(simplified(ours, 0.02 * float(np.ptp(height))), simplified(theirs, 0.02 * float(np.ptp(height))))
    accuracy = f"isomorphic after simplification: {'yes' if same else 'no'}; {len(ours.vertices)} critical points"
    return race(work, rival, 77, cost, their_cost, accuracy, fair=same)


def _vtk(vtk: Any, mesh: TriangleMesh, height: Floats) -> ReebGraph:
    from vtk.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray

    surface, points, cells, field = vtk.vtkPolyData(), vtk.vtkPoints(), vtk.vtkCellArray(), numpy_to_vtk(height)
    points.SetData(numpy_to_vtk(mesh.vertices))
    rows = np.column_stack([np.full(len(mesh.faces), 3), mesh.faces]).ravel()
    cells.SetCells(len(mesh.faces), numpy_to_vtkIdTypeArray(rows))
    surface.SetPoints(points)
    surface.SetPolys(cells)
    graph = vtk.vtkReebGraph()
    graph.Build(surface, field)
    output = vtk.vtkReebGraph.SafeDownCast(graph)
    names = output.GetVertexData().GetAbstractArray("Vertex Ids")
    vertices = np.array([int(names.GetTuple1(i)) for i in range(output.GetNumberOfVertices())])
    edges = [(output.GetSourceVertex(i), output.GetTargetVertex(i)) for i in range(output.GetNumberOfEdges())]
    arcs = np.array([(a, b) if height[vertices[a]] <= height[vertices[b]] else (b, a) for a, b in edges])
    return ReebGraph(vertices, height[vertices], arcs, np.full(len(height), -1))


def _like(first: ReebGraph, second: ReebGraph) -> bool:
    import networkx

    graphs = [networkx.MultiGraph(graph.arcs.tolist()) for graph in (first, second)]
    return bool(networkx.is_isomorphic(*graphs))


def _sampled_graph(size: int) -> Line:
    mesh = genus_surface(2, size).mesh
    height = mesh.vertices @ np.array([0.3, 0.5, 0.8])
    levels = choose_levels(mesh, height, 200, "uniform")
    graph, cost = measure(lambda: reeb_graph(mesh, height, levels))
    accuracy = f"{graph.metrics['b1']:.0f} loops for 2 handles"
    return within(f"Reeb graph of {size:,} V, 200 levels", 2.0, cost, accuracy, graph.metrics["b1"] == 2)


def _crossings(size: int) -> Line:
    mesh = genus_surface(2, size).mesh
    height = mesh.vertices @ np.array([0.3, 0.5, 0.8])
    counts, costs, crossings = (25, 50, 100, 200, 400, 800), [], []
    for count in counts:
        levels = choose_levels(mesh, height, count, "uniform")
        graph, cost = measure(lambda levels=levels: reeb_graph(mesh, height, levels))
        costs.append(cost)
        crossings.append(len(graph.contour_points))
    seconds = np.array([cost.cpu for cost in costs])
    slope, fixed = np.polyfit(np.array(crossings[:4], float), seconds[:4], 1)
    growth = float(seconds[-1] / (fixed + slope * crossings[-1]))
    work = f"Reeb graph of {len(mesh.vertices):,} V: {counts[0]} to {counts[-1]} levels, {crossings[-1]:,} crossings"
    seen = ", ".join(f"{n / 1000:.0f}k {t:.3g} s" for n, t in zip(crossings, seconds, strict=True))
    note = f"{1e9 * slope:.0f} ns for a crossing and {fixed:.2g} s for the mesh, from the first four"
    result, met = f"{growth:.2f}× the line", growth <= 1.25
    return Line(work, "the line through 25 to 200 levels", "1.25× the line", result, met, costs[-1], None, seen, note)


def _patch(edge_length: float, least: float) -> Line:
    mesh = callosum(0, edge_length=edge_length).mesh
    (skeleton, _), cost = measure(lambda: eigenmap_skeleton(mesh), 5)
    work = f"patch of {len(mesh.vertices):,} V: operator, eigenmap, 50 levels, graph and lengths"
    return within(work, least, cost, "a chain" if skeleton.is_chain else "not a chain", skeleton.is_chain)


def _module(name: str) -> Any:
    try:
        return importlib.import_module(name)
    except ImportError:
        return None
