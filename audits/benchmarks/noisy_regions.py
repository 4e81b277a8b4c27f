"""`python -m audits.benchmarks.noisy_regions [--seeds N]`: planted regions under the noises of docs/protocols/noise.md."""

from __future__ import annotations

import argparse
from collections import defaultdict
from collections.abc import Iterator

import numpy as np

import surfexp as sx
from audits.benchmarks.noisy_maps import NOISES, NoisyMap, half_cortex, smooth_field, with_noise
from surfexp.anatomy.subcortical import subcortical_surface
from surfexp.mesh.shapes.icosphere import icosphere
from surfexp.mesh.surface import Surface
from surfexp.operators.fem import fem
from surfexp.smoothing.noisy_phases import two_means
from surfexp.variational.truth_metrics import dice

SHARES = (0.5, 0.1, 0.02)
FIRST_SEED = 40
RULES = ("default", "rule of before", "two means of the denoised map")
LOSS_BOUND = 0.01
Scores = dict[tuple[str, float, str], list[dict[str, float]]]


def planted(surface: Surface, shape: str, share: float, seed: int) -> NoisyMap:
    """Return the indicator of a region with a share of the area: what is nearest to a vertex, or highest in a smooth field."""
    operator = fem(surface.mesh)
    vertices = surface.mesh.vertices
    if shape == "compact":
        middle = vertices[np.random.default_rng([seed, 7]).integers(len(vertices))]
        height = -np.linalg.norm(vertices - middle, axis=1)
    else:
        height = smooth_field(surface, seed)
    order = np.argsort(-height, kind="stable")
    inside = np.zeros(len(vertices))
    inside[order[: int(np.searchsorted(np.cumsum(operator.mass[order]), share * operator.mass.sum())) + 1]] = 1.0
    return NoisyMap("second", shape, surface, operator, inside)


def scores(clean: NoisyMap, noise: str, seed: int) -> dict[str, float]:
    """Dice of the planted region for every rule, by area."""
    rough, truth = with_noise(clean, noise, seed), clean.values > 0.5
    regions = {
        "default": sx.segment(clean.surface, rough).labels > 0,
        "rule of before": sx.segment(clean.surface, rough, smoothness=0.3).labels > 0,
        "two means of the denoised map": two_means(sx.denoise(clean.surface, rough).values, clean.operator.mass),
    }
    return {rule: dice(clean.operator.mass, region, truth) for rule, region in regions.items()}


def judging_surfaces() -> Iterator[tuple[str, Surface]]:
    """The three surfaces of the half that judges."""
    yield "hippocampus", subcortical_surface(donor="9861", structure="hippocampus", hemisphere="left", vertices=2500)
    yield "cortex, back", half_cortex("left", -1.0)
    yield "sphere", icosphere(4)


def all_scores(seeds: range) -> Scores:
    """Scores of every seed, by shape, share and noise."""
    found: Scores = defaultdict(list)
    for name, surface in judging_surfaces():
        for shape in ("compact", "scattered"):
            for share in SHARES:
                for seed in seeds:
                    clean = planted(surface, shape, share, seed)
                    for noise in NOISES:
                        one = scores(clean, noise, seed)
                        found[shape, share, noise].append(one)
                        print(name, shape, share, seed, noise, *(f"{one[rule]:.3f}" for rule in RULES), flush=True)
    return found


def table(found: Scores) -> str:
    """Mean Dice over surfaces and seeds, default and rule of before, and in how many cells it is worse by more than .01."""
    heads = [f"{shape} {share:g}" for shape, share in dict.fromkeys((shape, share) for shape, share, _ in found)]
    rows = ["| noise | " + " | ".join(heads) + " | worse |", "|---|" + "---|" * (len(heads) + 1)]
    for noise in NOISES:
        those = {key: cells for key, cells in found.items() if key[2] == noise}
        means = [
            " / ".join(f"{np.mean([cell[rule] for cell in cells]):.2f}" for rule in RULES) for cells in those.values()
        ]
        worse = [cell["default"] < cell["rule of before"] - LOSS_BOUND for cells in those.values() for cell in cells]
        rows.append(f"| {noise} | " + " | ".join(means) + f" | {sum(worse)} of {len(worse)} |")
    return "\n".join(rows)


def main() -> None:
    """Print every cell, then the table and the mean over all."""
    parser = argparse.ArgumentParser(prog="noisy_regions", description=__doc__)
    parser.add_argument("--seeds", type=int, default=2, help="seeds of each planted region (default 2)")
    found = all_scores(range(FIRST_SEED, FIRST_SEED + parser.parse_args().seeds))
    print("\n" + table(found))
    for rule in RULES:
        print(f"{rule}: mean {np.mean([cell[rule] for cells in found.values() for cell in cells]):.3f}")


if __name__ == "__main__":
    main()
