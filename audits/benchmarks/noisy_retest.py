"""`python -m audits.benchmarks.noisy_retest`: docs/protocols/noise.md, a run at rest as test and retest. Needs brainspace."""

from __future__ import annotations

import argparse
from collections import defaultdict
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Literal

import numpy as np

import surfexp as sx
from audits.benchmarks.noise_study import Filters
from audits.benchmarks.noisy_maps import NoisyMap
from surfexp.anatomy.resting_run import PARTS, connectivity_maps, resting_fsaverage5, run_on
from surfexp.contract.arrays import Floats
from surfexp.mesh.surface import Surface
from surfexp.operators.fem import fem
from surfexp.operators.surface_operator import SurfaceOperator
from surfexp.skeleton.fast_marching import fast_marching
from surfexp.smoothing.fitted_trials import WIDTHS
from surfexp.smoothing.heat_polynomial import heat_polynomials
from surfexp.smoothing.methods import heat_time

SIDES: tuple[Literal["left", "right"], ...] = ("left", "right")
PATCHES, RADIUS = 3, 10.0
# full widths in mm
FIXED_WIDTHS = (6.0, 10.0)


@dataclass(frozen=True, eq=False)
class Pair:
    """A map of connectivity measured twice, and a third time to judge.

    Parameters
    ----------
    name : str
    surface : Surface
    operator : SurfaceOperator
    test, retest, judge : (n,) float64
        Fisher's z.
    """

    name: str
    surface: Surface
    operator: SurfaceOperator
    test: Floats
    retest: Floats
    judge: Floats

    def distance(self, values: Floats) -> float:
        """Root mean square distance to the judge by area."""
        mass = self.operator.mass
        return float(np.sqrt(mass @ (values - self.judge) ** 2 / mass.sum()))


def pairs(patches: int = PATCHES) -> Iterator[Pair]:
    """Yield each patch of either side, with each part of the run in turn as the test."""
    for side in SIDES:
        surface = resting_fsaverage5(side)
        operator, (series, confounds) = fem(surface.mesh), run_on(surface)
        for seed in range(patches):
            centre = int(np.random.default_rng(seed).integers(operator.vertex_count))
            patch = fast_marching(surface.mesh, np.array([centre])) <= RADIUS
            maps = connectivity_maps(series, confounds, patch).T
            for part in range(PARTS):
                test, retest, judge = (np.ascontiguousarray(maps[(part + later) % PARTS]) for later in range(3))
                yield Pair(f"{side}, patch {seed}, part {part + 1}", surface, operator, test, retest, judge)


def distances(pair: Pair) -> dict[str, float]:
    """The distance to the judge after every rule, and of the noise what one map and two say."""
    edge = pair.operator.edge_length
    widths = [*FIXED_WIDTHS, *(width * edge for width in WIDTHS)]
    kernels = [
        found[0][:, 0]
        for found in heat_polynomials(pair.operator, pair.test[:, None], [heat_time(width) for width in widths], 1e-6)
    ]
    fixed, grid = kernels[: len(FIXED_WIDTHS)], kernels[len(FIXED_WIDTHS) :]
    held_out = min(grid, key=lambda values: float(pair.operator.mass @ (values - pair.retest) ** 2))
    alone, twice = sx.noise(pair.surface, pair.test), sx.noise(pair.surface, pair.test, pair.retest)
    clean = NoisyMap("", pair.name, pair.surface, pair.operator, pair.judge)
    found = {
        "nothing": pair.distance(pair.test),
        "default": pair.distance(sx.denoise(pair.surface, pair.test).values),
        "rule of before": Filters(clean).rule_of_before(pair.test)[0],
        "rof": pair.distance(sx.denoise(pair.surface, pair.test, method="rof").values),
        **{f"heat {width:g} mm": pair.distance(one) for width, one in zip(FIXED_WIDTHS, fixed, strict=True)},
        "default, noise from both": pair.distance(sx.denoise(pair.surface, pair.test, noise=twice).values),
        "heat, hold-out": pair.distance(held_out),
    }
    best = min(map(pair.distance, grid))
    ratios = {rule: value / best for rule, value in found.items()}
    kinds = {f"said alone: {kind}": 1.0 for kind in alone.kinds} | {
        f"said by both: {kind}": 1.0 for kind in twice.kinds
    }
    return ratios | {"level alone over both": alone.level / twice.level, "width by both, mm": twice.width} | kinds


def main() -> None:
    """Print the cells as they come, then mean and range of every row over them."""
    parser = argparse.ArgumentParser(prog="noisy_retest", description=__doc__)
    parser.add_argument("--patches", type=int, default=PATCHES, help="patches of either side")
    patches = parser.parse_args().patches
    rows: dict[str, list[float]] = defaultdict(list)
    cells = 0
    for pair in pairs(patches):
        found = distances(pair)
        cells += 1
        for name, value in found.items():
            rows[name].append(value)
        print(f"{pair.name}: " + ", ".join(f"{name} {value:.3f}" for name, value in found.items()), flush=True)
    print(f"\n| over {cells} cells | mean | least | largest | cells |\n|---|---|---|---|---|")
    for name, values in rows.items():
        print(f"| {name} | {np.mean(values):.3f} | {min(values):.3f} | {max(values):.3f} | {len(values)} |")


if __name__ == "__main__":
    main()
