"""Calls of the public functions, each with all that it takes from one bundle, and what it answers as arrays."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import numpy as np

import surfexp as sx
from surfexp.mesh.shapes.ellipsoid import ellipsoid
from surfexp.mesh.triangle_mesh import TriangleMesh
from surfexp.operators.assembly import mass_matrix, stiffness
from surfexp.operators.fem import fem
from surfexp.tasks.given_surface import as_surface

BODY = ellipsoid(semiaxes=(1.0, 1.3, 1.7), levels=2).mesh
V, F = BODY.vertices, BODY.faces
MAP = V[:, 2] + 0.3 * V[:, 0] + 0.1 * np.random.default_rng(0).standard_normal(len(V))
OTHER = sx.Surface(ellipsoid(semiaxes=(1.0, 1.2, 1.9), levels=2).mesh)

Answer = dict[str, Any]


@dataclass(frozen=True)
class Given:
    """What functions are given."""

    vertices: Any = field(default_factory=lambda: V)
    faces: Any = field(default_factory=lambda: F)
    values: Any = field(default_factory=lambda: MAP)
    mask: Any = None
    sources: Any = (3, 40)
    count: Any = 4
    seed: Any = 0
    width: Any = 0.4
    tolerance: Any = 1e-3
    stiffness: Any = field(default_factory=lambda: stiffness(fem(BODY)))
    mass: Any = field(default_factory=lambda: mass_matrix(fem(BODY)))
    unit: float = 1.0

    @property
    def surface(self) -> Any:
        pair = self.vertices, self.faces
        return pair if self.mask is None else sx.Surface(TriangleMesh(*pair), mask=self.mask)


@dataclass(frozen=True)
class Call:
    """A function: which parts of a bundle it takes, and what it answers.

    `units` and `map_units` are the powers of the units of length and of the map in the answers; those of `spreads` follow the
    unit of the map and not its offset. A call that mixes maps sets the given one beside others that keep their unit.
    Odd inputs that are named in `apart` are answered, and not as the reference is.
    """

    parts: str
    run: Callable[[Given, Path], Answer]
    units: dict[str, float] = field(default_factory=dict)
    map_units: dict[str, float] = field(default_factory=dict)
    spreads: tuple[str, ...] = ()
    mixes_maps: bool = False
    apart: tuple[str, ...] = ()

    def takes(self, part: str) -> bool:
        return part in self.parts.split()


def _surface(given: Given, _: Path) -> Answer:
    made = sx.Surface(TriangleMesh(given.vertices, given.faces), scalars={"map": given.values}, mask=given.mask)
    as_surface(made)
    answer: Answer = {"vertices": made.mesh.vertices, "faces": made.mesh.faces, "map": made.scalars["map"]}
    return answer if made.mask is None else answer | {"mask": made.mask}


def _check(given: Given, _: Path) -> Answer:
    report = sx.check((given.vertices, given.faces))
    assert report.ok == all(line.startswith("note") or line == "no defect" for line in report.lines())
    return {} if report.ok else _refused({"": f"{report.lines()[0]}: sx.repair mends what is repairable"})


def _repair(given: Given, _: Path) -> Answer:
    made = sx.repair((given.vertices, given.faces))
    assert sx.check(made).ok
    return {"vertices": made.mesh.vertices, "faces": made.mesh.faces}


def _write(given: Given, folder: Path) -> Answer:
    sx.write(folder / "body.vtp", sx.Surface(TriangleMesh(given.vertices, given.faces)))
    again = sx.read(folder / "body.vtp")
    return {"vertices": again.mesh.vertices, "faces": again.mesh.faces}


def _write_map(given: Given, folder: Path) -> Answer:
    sx.write(folder / "map.npz", {"map": given.values})
    sx.write(folder / "body.ply", sx.Surface(BODY))
    return {"map": sx.read(folder / "body.ply", maps={"map": folder / "map.npz"}).scalars["map"]}


def _read(given: Given, folder: Path) -> Answer:
    sx.write(folder / "body.ply", sx.Surface(BODY))
    return {"mask": sx.read(folder / "body.ply", mask=given.mask).mask}


def _pairs(found: Any) -> Answer:
    return {"values": found.values, "vectors": np.abs(found.vectors)}


def _eigsh(given: Given, _: Path) -> Answer:
    values, vectors = sx.eigsh(given.stiffness, k=given.count, M=given.mass, sigma=-0.01)
    return {"values": values, "vectors": np.abs(vectors)}


def _distance(found: Any) -> Answer:
    return {"value": found.value, "lower bound": found.lower_bound}


def _fingerprint(given: Given, folder: Path) -> Answer:
    sx.write(folder / "body.ply", sx.Surface(BODY))
    found = sx.fingerprint([folder / "body.ply"], given.count, tolerance=given.tolerance)
    return {"column": next(iter(found.columns.values()))} if found.columns else _refused(found.refused)


def _refused(reasons: dict[str, str]) -> Answer:
    raise ValueError(next(iter(reasons.values())))


def _shape(given: Given, _: Path) -> Answer:
    mesh = sx.shape("icosphere", levels=given.count, radius=given.width).mesh
    return {"vertices": mesh.vertices, "faces": mesh.faces}


def _segment(given: Given, _: Path) -> Answer:
    found = sx.segment(given.surface, given.values, smoothness=given.width)
    return {"labels": found.labels, "c1": found.c1, "c2": found.c2}


def _reeb(given: Given, _: Path) -> Answer:
    graph = sx.reeb_graph(given.surface, given.values, count=given.count)
    return {"positions": graph.positions, "arcs": graph.arcs, "values": graph.values}


def _width(given: Given) -> Any:
    return given.width if given.unit == 1.0 else given.width * given.unit


def _null_maps(given: Given, _: Path) -> Answer:
    return {"map": sx.null_maps(given.surface, given.values, given.count, modes=9, seed=given.seed).values}


def _plot(given: Given, _: Path) -> Answer:
    return {"pixels": sx.plot(given.surface, given.values, width=200).figure.pixels}


def _waves(given: Given, count: int) -> Any:
    """Other maps of the same surface."""
    vertices = len(given.vertices) if hasattr(given.vertices, "__len__") else len(V)
    return np.cos(np.arange(1.0, vertices + 1.0)[:, None] * np.arange(1.0, count + 1.0))


def _compare_maps(given: Given, _: Path) -> Answer:
    partner = _waves(given, 1)[:, 0]
    found = sx.compare_maps(given.surface, given.values, partner, count=given.count, modes=9, seed=given.seed)
    return {"r": found.r, "null": found.null, "p": found.p, "interval": np.array(found.interval)}


def _permutation_test(given: Given, _: Path) -> Answer:
    found = sx.permutation_test(
        given.surface,
        [given.values, *_waves(given, 7).T],
        groups=[*"aabbabab"],
        count=given.count,
        seed=given.seed,
        forming_p=0.05,
    )
    return {name: found.maps[name] for name in ("p_t", "p_tfce", "p_extent", "q_t")}


def _parcels(given: Given, _: Path) -> Answer:
    labels = 1 + np.arange(len(_waves(given, 1))) % 3
    found = sx.parcels(given.surface, given.values, labels)
    return {"mean": found.means, "median": found.medians, "area": found.areas}


def _noise(given: Given, _: Path) -> Answer:
    found = sx.noise(given.surface, given.values)
    return {"level": found.level, "levels": found.levels}


def _path(given: Given, _: Path) -> Answer:
    path = sx.denoise_path(given.surface, given.values, weights=(given.width, 3.0), tolerance=given.tolerance)
    return {"map": path.at(1.0).values}


def _view(given: Given, folder: Path) -> Answer:
    sx.view(given.surface, given.values).save(folder / "page.html")
    return {}


def _reeb_distance(given: Given, _: Path) -> Answer:
    graph = sx.reeb_graph(given.surface, given.values, count=given.count)
    flat = replace(graph, values=np.full_like(graph.values, graph.values.mean()))
    found = sx.reeb_distance(graph, graph), sx.reeb_distance(graph, flat)
    assert found[0].upper == 0.0 and not sx.check_reeb_distance(found[1], graph, flat)
    return {"upper": found[1].upper}


CALLS = {
    "Surface": Call("vertices faces values mask", _surface, {"vertices": 1}, {"map": 1}),
    "check": Call("vertices faces", _check),
    "repair": Call("vertices faces", _repair, {"vertices": 1}),
    "write": Call("vertices faces", _write, {"vertices": 1}),
    "write map": Call("values", _write_map, {}, {"map": 1}),
    "read": Call("mask", _read),
    "eigenpairs": Call(
        "vertices faces mask count",
        lambda given, _: _pairs(sx.eigenpairs(given.surface, given.count)),
        {"values": -2, "vectors": -1},
    ),
    "Spectrum": Call(
        "vertices faces mask count tolerance",
        lambda given, _: _pairs(sx.Spectrum(given.surface, tolerance=given.tolerance).first(given.count)),
        {"values": -2, "vectors": -1},
    ),
    "eigsh": Call("count stiffness mass", _eigsh),
    "ShapeDNA": Call(
        "vertices faces mask count", lambda given, _: {"row": sx.ShapeDNA(n=given.count).fit_transform([given.surface])}
    ),
    "NodalCounts": Call(
        "vertices faces mask count",
        lambda given, _: {"row": sx.NodalCounts(n=given.count).fit_transform([given.surface])},
    ),
    "SpectralDistance": Call(
        "vertices faces mask count",
        lambda given, _: {"row": sx.SpectralDistance(n=given.count).fit_transform([given.surface, OTHER])},
    ),
    "distance": Call(
        "vertices faces mask count", lambda given, _: _distance(sx.distance(given.surface, OTHER, given.count))
    ),
    "align": Call("vertices faces mask count", lambda given, _: _distance(sx.align(given.surface, OTHER, given.count))),
    "denoise": Call(
        "vertices faces values mask width tolerance",
        lambda given, _: {
            "map": sx.denoise(
                given.surface, given.values, method="rof", weight=given.width, tolerance=given.tolerance
            ).values
        },
        {},
        {"map": 1},
    ),
    "denoise by itself": Call(
        "vertices faces values mask",
        lambda given, _: {"map": sx.denoise(given.surface, given.values).values},
        {},
        {"map": 1},
    ),
    "smooth": Call(
        "vertices faces values mask width",
        lambda given, _: {"map": sx.smooth(given.surface, given.values, _width(given)).values},
        {},
        {"map": 1},
    ),
    "segment": Call("vertices faces values mask width", _segment, {}, {"c1": 1, "c2": 1}),
    "geodesic": Call(
        "vertices faces mask sources",
        lambda given, _: {"map": sx.geodesic(given.surface, given.sources)},
        {"map": 1},
    ),
    "mean_curvature": Call(
        "vertices faces mask", lambda given, _: {"map": sx.mean_curvature(given.surface)}, {"map": -1}
    ),
    "reeb_graph": Call("vertices faces values mask count", _reeb, {"positions": 1}, {"values": 1}),
    "null_maps": Call("vertices faces values mask count seed", _null_maps, {}, {"map": 1}),
    "compare_maps": Call("vertices faces values mask count seed", _compare_maps),
    "permutation_test": Call("vertices faces values mask count seed", _permutation_test, mixes_maps=True),
    "parcels": Call(
        "vertices faces values mask",
        _parcels,
        {"area": 2},
        {"mean": 1, "median": 1},
        # maps may be unknown at different vertices, so that areas are those of the surface; a mask cuts faces off
        apart=("values: NaN",),
    ),
    "noise": Call("vertices faces values mask", _noise, {}, {"level": 1, "levels": 1}, ("level", "levels")),
    "denoise_path": Call("vertices faces values mask width tolerance", _path, {}, {"map": 1}),
    "plot": Call("vertices faces values mask", _plot),
    "view": Call("vertices faces values mask", _view),
    "reeb_distance": Call("vertices faces values count", _reeb_distance, {}, {"upper": 1}, ("upper",)),
    "fingerprint": Call("count tolerance", _fingerprint),
    "shape": Call("count width", _shape),
}
