"""`python -m audits.benchmarks.permutation_levels TABLE FILE [--sets N]`: docs/protocols/test_levels.md, resumed from FILE."""

from __future__ import annotations

import argparse
import json
from collections import defaultdict
from collections.abc import Callable, Iterator
from functools import cache
from importlib import import_module
from itertools import product
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_array
from scipy.stats import beta
from scipy.stats import t as student

from surfexp.contract.arrays import Floats
from surfexp.inference.cluster_enhancement import enhanced
from surfexp.inference.clusters import clusters_beyond
from surfexp.inference.corrections import family_wise
from surfexp.inference.designs import tested
from surfexp.inference.exchangeability import allowed_rearrangements
from surfexp.inference.linear_model import contrast_model
from surfexp.inference.permutation_inference import Statistics, null_distributions
from surfexp.inference.vertex_graph import VertexGraph, vertex_graph
from surfexp.mesh.shapes.icosphere import icosphere
from surfexp.mesh.surface import Surface
from surfexp.mesh.triangle_mesh import TriangleMesh
from surfexp.spectrum.lowest_pairs import lowest_pairs

MAPS, COUNT, LEVEL, FORMING_P, MODES = 20, 200, 0.05, 0.01, 225
SETS, WIDTHS = {"level": 1000, "power": 100}, (0.5,)
# a heat kernel of time w^2 / (16 log 2) has the full width w at half maximum
TIME = 1.0 / (16.0 * np.log(2.0))
DISKS = ((0.2, 0.8), (0.5, 0.45), (1.0, 0.35))
STATISTICS, MNE_STEP, MNE_POWERS = ("t", "extent", "mass", "tfce"), 0.2, (0.5, 2.0)
DESIGNS = ("one sample", "pairs", "two groups", "groups and covariate", "slope of a covariate", "one sample, skewed")
Result = dict[str, float]


@cache
def ball() -> tuple[TriangleMesh, VertexGraph, Floats, Floats]:
    """The sphere, its graph, eigenvalues and eigenfunctions."""
    surface = icosphere(levels=3)
    _, pairs = lowest_pairs(Surface(surface.mesh), MODES)
    return surface.mesh, vertex_graph(surface.mesh), pairs.values, pairs.vectors


def fields(width: float, random: np.random.Generator, skewed: bool = False) -> Floats:
    """Smooth Gaussian noise of variance 1 on average, (MAPS, n); skewed, its square less 1 over the root of 2."""
    _, _, values, vectors = ball()
    shares = np.exp(-values * TIME * width**2)
    shares /= np.sqrt((shares**2 * vectors**2).sum(axis=1).mean())
    found = random.standard_normal((MAPS, len(values))) * shares @ vectors.T
    return np.asarray((found**2 - 1.0) / np.sqrt(2.0) if skewed else found)


def arguments_of(design: str, random: np.random.Generator) -> dict[str, Floats | NDArray[np.str_]]:
    """What `permutation_test` is given beside the maps."""
    half = np.repeat([1.0, 0.0], MAPS // 2)
    groups = np.where(half > 0.0, "a", "b")
    age = random.standard_normal(MAPS)
    if design == "pairs":
        return {"groups": groups, "pairs": np.tile(np.arange(MAPS // 2), 2)}
    if design == "two groups":
        return {"groups": groups}
    if design == "groups and covariate":
        return {"groups": groups, "covariates": age + half}
    if design == "slope of a covariate":
        other = random.standard_normal(MAPS)
        matrix = np.column_stack([np.ones(MAPS), age, other, age + other + random.standard_normal(MAPS)])
        return {"design": matrix, "contrast": np.array([0.0, 0.0, 0.0, 1.0])}
    return {}


def levels_of(design: str, width: float, seed: int) -> Result:
    """The least family-wise p of each statistic on one data set without effect."""
    random = np.random.default_rng([1, DESIGNS.index(design), WIDTHS.index(width), seed])
    data = fields(width, random, skewed=design.endswith("skewed"))
    given = arguments_of(design, random)
    names = ("design", "contrast", "groups", "pairs", "covariates")
    data, asked = tested(data, *(given.get(name) for name in names))
    model = contrast_model(data, asked.matrix, asked.contrast)
    chosen, _ = allowed_rearrangements(model, asked.matrix, None, "within", "auto", COUNT, random)
    threshold = float(student.isf(FORMING_P / 2.0, model.freedom))
    found = null_distributions(model, chosen, Statistics(ball()[1], threshold))
    # the first rearrangement is the data as they are
    return {name: float(family_wise(found.largest[name][:1], found.largest[name])[0]) for name in STATISTICS}


def powers_of(disk: tuple[float, float], _: float, seed: int) -> Result:
    """The least family-wise p of each method inside a disk of effect."""
    mesh, graph, _, _ = ball()
    random = np.random.default_rng([2, DISKS.index(disk), seed])
    data, middle = fields(WIDTHS[0], random), mesh.vertices[random.integers(len(mesh.vertices))]
    inside = np.arccos(np.clip(mesh.vertices @ middle, -1.0, 1.0)) <= disk[0]
    data = data + disk[1] * inside
    model = contrast_model(data, np.ones((MAPS, 1)), np.ones(1))
    chosen, _ = allowed_rearrangements(model, np.ones((MAPS, 1)), None, "within", "auto", COUNT, random)
    threshold = float(student.isf(FORMING_P / 2.0, model.freedom))
    found = null_distributions(model, chosen, Statistics(graph, threshold))
    clusters = clusters_beyond(found.t, graph, threshold)
    met = np.unique(clusters.labels[inside & (clusters.labels >= 0)])
    largest = {
        "t": np.abs(found.t[inside]).max(),
        "tfce": np.abs(found.tfce[inside]).max(),
        "extent": clusters.areas[met].max(initial=0.0),
        "mass": clusters.masses[met].max(initial=0.0),
    }
    p = {name: float(family_wise(np.array([largest[name]]), found.largest[name])[0]) for name in STATISTICS}
    extent, height = MNE_POWERS
    other = null_distributions(model, chosen, Statistics(graph, threshold, extent, height))
    seen = np.array([np.abs(enhanced(other.t, graph, extent_power=extent)[inside]).max()])
    p["tfce E = .5"] = float(family_wise(seen, other.largest["tfce"])[0])
    return p | {"mne": _p_of_mne(data, graph, inside, seed)}


def _p_of_mne(data: Floats, graph: VertexGraph, inside: NDArray[np.bool_], seed: int) -> float:
    try:
        stats = import_module("mne.stats")
    except ImportError:
        return float("nan")
    ring = csr_array((np.ones(len(graph.neighbours)), graph.neighbours, graph.starts), shape=(len(inside),) * 2)
    found = stats.permutation_cluster_1samp_test(
        data,
        threshold={"start": 0, "step": MNE_STEP},
        n_permutations=COUNT,
        adjacency=ring,
        out_type="mask",
        seed=seed,
        verbose="error",
    )
    return float(found[2][inside].min())


TABLES: dict[str, tuple[Callable[..., Result], list[tuple[object, float]]]] = {
    "level": (levels_of, list(product(DESIGNS, WIDTHS))),
    "power": (powers_of, [(disk, WIDTHS[0]) for disk in DISKS]),
}


def interval(hits: int, trials: int, tail: float = 0.05) -> tuple[float, float]:
    """Clopper and Pearson's interval of a share, which misses it with probability at most `tail`."""
    low = float(beta.ppf(tail / 2.0, hits, trials - hits + 1)) if hits else 0.0
    return low, float(beta.ppf(1.0 - tail / 2.0, hits + 1, trials - hits)) if hits < trials else 1.0


def rows_of(file: Path) -> Iterator[tuple[str, int, Result]]:
    """The cell, the seed and the p-values of each data set in a file."""
    for line in file.read_text(encoding="utf-8").splitlines() if file.exists() else ():
        cell, seed, p = json.loads(line)
        yield cell, seed, p


def table_of(file: Path) -> str:
    """Shares of data sets with p at most LEVEL in per cent, with intervals at 95 %; two stars where a level is broken."""
    cells: dict[str, list[Result]] = defaultdict(list)
    for cell, _, p in rows_of(file):
        cells[cell].append(p)
    names = list(next(iter(cells.values()), [{}])[0])
    lines = ["| | sets | " + " | ".join(names) + " |", "|---|---|" + "---|" * len(names)]
    for cell, found in cells.items():
        hits = [sum(p[name] <= LEVEL for p in found) for name in names]
        texts = []
        for count in hits:
            low, high = interval(count, len(found))
            wide = interval(count, len(found), 0.05 / (len(cells) * len(names)))
            text = f"{100.0 * count / len(found):.1f} ({100.0 * low:.1f}, {100.0 * high:.1f})"
            broken = not wide[0] <= LEVEL <= wide[1]
            texts.append(f"{text} **" if broken else text if low <= LEVEL <= high else f"{text} *")
        lines.append(f"| {cell} | {len(found)} | " + " | ".join(texts) + " |")
    return "\n".join(lines)


def main() -> None:
    """Run what a file does not have yet, and print its table."""
    parser = argparse.ArgumentParser(prog="permutation_levels", description=__doc__)
    parser.add_argument("table", choices=TABLES)
    parser.add_argument("file", type=Path, help="a line for each data set; those that it has are not run again")
    parser.add_argument("--sets", type=int, help="data sets of each row")
    parser.add_argument("--first-seed", type=int, default=0)
    options = parser.parse_args()
    work, cells = TABLES[options.table]
    done = {(cell, seed) for cell, seed, _ in rows_of(options.file)}
    seeds = range(options.first_seed, options.first_seed + (options.sets or SETS[options.table]))
    with options.file.open("a", encoding="utf-8") as stream:
        for seed, (first, width) in product(seeds, cells):
            cell = f"{first}, {width:g}"
            if (cell, seed) not in done:
                stream.write(json.dumps([cell, seed, work(first, width, seed)]) + "\n")
                stream.flush()
    print(table_of(options.file))


if __name__ == "__main__":
    main()
