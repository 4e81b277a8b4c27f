"""Skeletons of nets of tubes of known radii and loops, beside skeletor and kimimaro.

Both are under the GPL and come with no extra: `pip install skeletor kimimaro` to run their lines.
"""

from __future__ import annotations

import importlib
from collections.abc import Callable
from typing import Any

import numpy as np

import surfexp as sx
from audits.benchmarks.line import Line, not_installed, race, within
from audits.benchmarks.measurement import measure, measure_both
from audits.benchmarks.nets_of_tubes import NetOfTubes, errors_of_tubes, net_of_tubes
from surfexp.contract.arrays import Floats
from surfexp.mesh.triangle_mesh import TriangleMesh
from surfexp.skeleton.fast_marching import fast_marching

SEED, RADIUS, LEVELS = 3, 0.1, 60
# positions, radii, loops
Found = tuple[Floats, Floats, int]
NANOMETRES = 1000.0  # kimimaro's parameters are for lengths of this size


def warm_up() -> None:
    """Compile what the lines use."""
    _own(net_of_tubes(SEED, RADIUS, 0.08))


def lines(quick: bool) -> list[Line]:
    """Return a line for each rival, and one for a million faces."""
    net = net_of_tubes(SEED, RADIUS, 0.04 if quick else 0.02)
    found = [
        _race(net, "skeletor, wavefront", "skeletor", 1.0, _wavefront),
        _race(net, "skeletor, contracted mesh", "skeletor", 10.0, _contracted),
        _race(net, "kimimaro, from voxels", "kimimaro", 1.0, _voxels),
    ]
    large = net_of_tubes(SEED, RADIUS, 0.04 if quick else 0.0048)
    (places, radii, loops), cost = measure(lambda: _own(large))
    errors, _ = errors_of_tubes(large, places, radii)
    accuracy = f"{loops} of {large.rings} loops, largest error of a radius {100.0 * errors.max():.1f} %"
    work = f"skeleton with radii of a net of {len(large.axes)} tubes, {len(large.mesh.faces):,} faces"
    return [*found, within(work, 10.0, cost, accuracy, loops == large.rings and bool(errors.max() < 0.02))]


def _own(net: NetOfTubes) -> Found:
    mesh = TriangleMesh(net.mesh.vertices, net.mesh.faces)
    source = int(np.argmin(mesh.vertices @ np.array([1.0, 0.3, 0.2])))
    found = sx.reeb_graph(mesh, fast_marching(mesh, np.array([source])), count=LEVELS, levels="critical")
    contours = found.kinds == 0
    return found.positions[contours], found.radii[contours], int(found.metrics["b1"])


def _race(net: NetOfTubes, rival: str, package: str, least: float, run: Callable[[Any, NetOfTubes], Found]) -> Line:
    work = f"skeleton with radii of a net of {len(net.axes)} tubes, {len(net.mesh.faces):,} faces"
    try:
        module = importlib.import_module(package)
    except ImportError:
        return not_installed(work, rival, least, package)
    (ours, cost), (theirs, their_cost) = measure_both(lambda: _own(net), lambda: run(module, net), 3)
    (error, offset), (their_error, their_offset) = (
        [float(found.mean()) for found in errors_of_tubes(net, *one[:2])] for one in (ours, theirs)
    )
    accuracy = (
        f"mean error of the radii of tubes {100.0 * error:.1f} %, rival {100.0 * their_error:.1f} %; off the axis "
        f"{offset:.3f} and {their_offset:.3f} radii; loops {ours[2]} and {theirs[2]} of {net.rings}"
    )
    return race(work, rival, least, cost, their_cost, accuracy, fair=error <= their_error and ours[2] == net.rings)


def _wavefront(skeletor: Any, net: NetOfTubes) -> Found:
    return _of_skeletor(skeletor.skeletonize.by_wavefront(_trimesh(net), waves=1, step_size=1, progress=False))


def _contracted(skeletor: Any, net: NetOfTubes) -> Found:
    mesh = _trimesh(net)
    thin = skeletor.pre.contract(mesh, epsilon=0.1, progress=False)
    found = skeletor.skeletonize.by_vertex_clusters(thin, sampling_dist=net.radius, progress=False)
    skeletor.post.radii(found, mesh, method="knn")
    return _of_skeletor(found)


def _of_skeletor(found: Any) -> Found:
    nodes = found.swc
    loops = len(found.edges) - len(found.vertices) + 1
    return nodes[["x", "y", "z"]].to_numpy(float), nodes["radius"].to_numpy(float), loops


def _trimesh(net: NetOfTubes) -> Any:
    import trimesh

    return trimesh.Trimesh(net.mesh.vertices, net.mesh.faces, process=False)


def _voxels(kimimaro: Any, net: NetOfTubes) -> Found:
    parameters = dict(kimimaro.intake.DEFAULT_TEASAR_PARAMS, scale=1.5, const=1.5 * NANOMETRES * net.radius)
    found = kimimaro.skeletonize(
        net.inside.astype(np.uint32),
        teasar_params=parameters,
        anisotropy=(NANOMETRES * net.spacing,) * 3,
        dust_threshold=10,
        progress=False,
        parallel=1,
    )[1]
    places = found.vertices.astype(float) / NANOMETRES - 0.4
    return places, found.radius.astype(float) / NANOMETRES, len(found.edges) - len(found.vertices) + 1
