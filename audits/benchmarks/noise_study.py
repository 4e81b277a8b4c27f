"""`python -m audits.benchmarks.noise_study [errors] [alarms] [--half HALF] [--seeds N]`: docs/protocols/noise.md."""

from __future__ import annotations

import argparse
from collections import defaultdict
from collections.abc import Iterable, Iterator

import numpy as np

import surfexp as sx
from audits.benchmarks.noisy_maps import NOISES, SEEDS, NoisyMap, conte69_maps, rough_maps, study_maps, with_noise
from surfexp.contract.arrays import Floats
from surfexp.mesh.triangle_mesh import TriangleMesh
from surfexp.operators.fem import fem
from surfexp.smoothing.automatic import CANDIDATES, EDGE_OF_GRIDS
from surfexp.smoothing.fitted_trials import fitted_trials
from surfexp.smoothing.methods import MethodName, Methods
from surfexp.smoothing.parameter_choice import smooth_on_grid
from surfexp.variational.noise_reading import read_noise, without_outliers
from surfexp.variational.own_unit import own_unit

HALVES = ("first", "second", "conte69")
IN_HINDSIGHT: dict[str, MethodName] = {
    "heat in hindsight": "heat_polynomial",
    "neighbours in hindsight": "neighbour_mean",
    "Gaussian in hindsight": "geodesic_gaussian",
}
RULES = ("default", "rule of before", "rof", *IN_HINDSIGHT)
ALARM_LEVELS, ALARM_DRAWS = (0.1, 0.3, 1.0), {"first": 6, "second": 4, "conte69": 2}
# a table's cell: errors by rule
Cells = dict[tuple[str, str], list[dict[str, float]]]


class Filters:
    """One map of the study, and what its filters share over noises and seeds."""

    def __init__(self, clean: NoisyMap):
        self.clean = clean
        # the grids of widths are those of cortices with such edges
        scale = EDGE_OF_GRIDS / clean.operator.edge_length
        self.mesh = TriangleMesh(scale * clean.surface.mesh.vertices, clean.surface.mesh.faces)
        self.methods = Methods(self.mesh, fem(self.mesh), 1.0)

    def errors(self, noise: str, seed: int) -> dict[str, float]:
        """Root mean square errors of every rule, and "best", the least of all filters with all their parameters."""
        rough = with_noise(self.clean, noise, seed)
        before, tried = self.rule_of_before(rough)
        tried += self._filters_of_default(rough)
        found = {
            "default": self._error(sx.denoise(self.clean.surface, rough).values),
            "rule of before": before,
            "rof": self._error(sx.denoise(self.clean.surface, rough, method="rof").values),
        }
        for rule, name in IN_HINDSIGHT.items():
            smoother, grid = self.methods.smoother(name)
            found[rule] = min(self._error(smoother(rough[:, None], parameter)[:, 0]) for parameter in grid)
        return found | {"best": min(*found.values(), *tried)}

    def rule_of_before(self, rough: Floats) -> tuple[float, list[float]]:
        """The error of the least estimate for white noise after outliers are replaced, and those of all its filters."""
        operator = self.clean.operator
        values = without_outliers(operator, rough, read_noise(operator, rough).outliers)
        methods = Methods(self.mesh, self.methods.operator, read_noise(operator, values).level)
        estimates, errors = [], []
        for name in CANDIDATES:
            smoother, grid = methods.smoother(name)
            run = smooth_on_grid(smoother, values[:, None], grid, methods.operator.mass, methods.noise)
            estimates.extend(run.stein)
            errors.extend(self._error(one[:, 0]) for one in run.values)
        return errors[int(np.argmin(estimates))], errors

    def _filters_of_default(self, rough: Floats) -> list[float]:
        """The errors of all filters that the default mixes, outliers replaced before."""
        operator, own = self.clean.operator, own_unit(rough)
        unit = own.normalised(rough)
        noise = read_noise(operator, unit)
        trials = fitted_trials(operator, without_outliers(operator, unit, noise.outliers), noise)
        return [self._error(own.restored(trial.values)) for trial in trials]

    def _error(self, values: Floats) -> float:
        mass = self.clean.operator.mass
        return float(np.sqrt(mass @ (values - self.clean.values) ** 2 / mass.sum()))


def chosen_maps(halves: Iterable[str]) -> Iterator[NoisyMap]:
    """The maps of some halves; those of conte69 need brainspace."""
    yield from (clean for clean in study_maps() if clean.half in halves)
    if "conte69" in halves:
        yield from conte69_maps()


def cells(halves: Iterable[str], seeds: Iterable[int]) -> Cells:
    """Errors of every rule, for each seed, by the name of a map and its noise."""
    found: Cells = defaultdict(list)
    for clean in chosen_maps(halves):
        filters = Filters(clean)
        for noise in NOISES:
            found[clean.name, noise] = [filters.errors(noise, seed) for seed in seeds]
        print(f"{clean.name}: done", flush=True)
    return found


def ratio_table(found: Cells) -> str:
    """Mean ratio to the best in hindsight over maps and seeds, and in brackets the largest mean of a map; errors of "none"."""
    rows = ["| noise | " + " | ".join(RULES) + " |", "|---|" + "---|" * len(RULES)]
    for noise in NOISES:
        means = {}
        for (_, name), errors in found.items():
            if name == noise:
                for rule in RULES:
                    scale = [1.0 if noise == "none" else one["best"] for one in errors]
                    ratios = [one[rule] / best for one, best in zip(errors, scale, strict=True)]
                    means.setdefault(rule, []).append(float(np.mean(ratios)))
        texts = [f"{np.mean(means[rule]):.3f} ({max(means[rule]):.2f})" for rule in RULES]
        rows.append(f"| {noise} | " + " | ".join(texts) + " |")
    return "\n".join(rows)


def alarm_table(halves: Iterable[str], first_seed: int) -> str:
    """For each map, in how many draws of white noise of three levels the reading says anything, and what."""
    rows = ["| map | draws | not white | said |", "|---|---|---|---|"]
    for clean in (*chosen_maps(halves), *(rough_maps() if "first" in halves else ())):
        said: list[str] = []
        draws = [(level, seed) for level in ALARM_LEVELS for seed in range(ALARM_DRAWS[clean.half])]
        for level, seed in draws:
            white = np.random.default_rng([first_seed + seed, 99]).standard_normal(len(clean.values))
            kinds = read_noise(clean.operator, clean.values + level * white).kinds
            said += [f"{level:g}: {', '.join(kinds)}"] if kinds else []
        counts = "; ".join(f"{name} x {said.count(name)}" for name in sorted(set(said)))
        rows.append(f"| {clean.name} | {len(draws)} | {len(said)} | {counts} |")
    return "\n".join(rows)


def main() -> None:
    """Print the tables that are named, all by default."""
    parser = argparse.ArgumentParser(prog="noise_study", description=__doc__)
    parser.add_argument("tables", nargs="*", metavar="TABLE", help="errors, alarms")
    parser.add_argument("--half", choices=HALVES, help="one half of the maps, both if not given, or those of conte69")
    parser.add_argument("--seeds", type=int, default=SEEDS, help="seeds of each noise")
    parser.add_argument("--first-seed", type=int, default=0, help="where the seeds begin")
    options = parser.parse_args()
    halves = (options.half,) if options.half else HALVES[:2]
    seeds = range(options.first_seed, options.first_seed + options.seeds)
    for half in halves:
        if not options.tables or "errors" in options.tables:
            print(f"\n{half} half, errors over the best in hindsight\n\n{ratio_table(cells((half,), seeds))}")
        if not options.tables or "alarms" in options.tables:
            print(f"\n{half} half, white noise\n\n{alarm_table((half,), options.first_seed)}")


if __name__ == "__main__":
    main()
