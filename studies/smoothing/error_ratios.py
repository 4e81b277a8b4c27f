"""Errors of methods on the same units, as ratios to that of a reference, with intervals."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from surfexp.contract.arrays import Floats, Integers
from surfexp.contract.member import Member
from surfexp.statistics.statistic import Statistic
from surfexp.variational.solution import Solution

DRAWS = 10_000
CENTRAL = (2.5, 97.5)
MARGIN = 0.02


def error_ratios(
    solutions: Mapping[Member, Solution], metric: str, reference: str, baseline: str, seed: int = 0
) -> Statistic:
    """Compare methods with a reference and a baseline, unit by unit.

    Parameters
    ----------
    solutions : mapping of Member to Solution
        The class of a member is its method; members of each method stand in the same order of units; the group is what is
        drawn together.
    metric : str
        The error.
    reference, baseline : str
        Methods to divide by.
    seed : int
        Of the bootstrap.

    Returns
    -------
    Statistic
        Rows: the methods. Columns, each with its 95 % interval: `to_reference` and `to_baseline`, medians of the ratios;
        `failed`, units without a converged result, which count in no ratio; `verdict`: 1 wins (interval under .98), -1 loses
        (over 1.02), 0 as good, NaN where a unit failed. Metrics: `ratio METHOD` and its ends, `failed METHOD`.

    Raises
    ------
    ValueError
        If reference or baseline is no method, or methods have different units.
    """
    methods = list(dict.fromkeys(member.class_name for member in solutions))
    for name in (reference, baseline):
        if name not in methods:
            raise ValueError(f"{name!r} is no method here, choose one of {', '.join(methods)}")
    groups = [member.group for member in solutions if member.class_name == reference]
    for method in methods:
        if (other := [member.group for member in solutions if member.class_name == method]) != groups:
            raise ValueError(f"{method!r} has units {other}, {reference!r} has {groups}: they must be the same")
    errors = {name: _errors(solutions, name, metric) for name in methods}
    owners = np.unique(groups, return_inverse=True)[1]
    draws = np.random.default_rng(seed).integers(owners.max() + 1, size=(DRAWS, owners.max() + 1))
    to_reference, to_baseline = (
        {name: median_ratio(errors[name] / errors[by], owners, draws) for name in methods}
        for by in (reference, baseline)
    )
    failed = {name: float(np.isnan(values).sum()) for name, values in errors.items()}
    columns = {
        "to_reference": np.array(list(to_reference.values())),
        "to_baseline": np.array(list(to_baseline.values())),
        "failed": np.array(list(failed.values())),
        "verdict": np.array([verdict(to_reference[name], failed[name]) for name in methods]),
    }
    metrics = {"units": float(len(groups)), "groups": float(owners.max() + 1)}
    for name, (middle, low, high) in to_reference.items():
        metrics |= {f"ratio {name}": middle, f"low {name}": low, f"high {name}": high, f"failed {name}": failed[name]}
    return Statistic(f"errors over those of {reference}".replace("_", " "), columns, tuple(methods), metrics)


def _errors(solutions: Mapping[Member, Solution], method: str, metric: str) -> Floats:
    own = [found for member, found in solutions.items() if member.class_name == method]
    lacking = [found.solver for found in own if metric not in found.metrics]
    if lacking:
        raise ValueError(f"{len(lacking)} of {len(own)} results of {method!r} have no metric {metric!r}")
    return np.array([found.metrics[metric] if found.converged else np.nan for found in own])


def median_ratio(ratios: Floats, owners: Integers, draws: Integers) -> tuple[float, float, float]:
    """Return the median of ratios and the central 95 % of it over draws of whole groups.

    Parameters
    ----------
    ratios : (u,) float64
        NaN where a unit failed.
    owners : (u,) int64
        Group of each unit, 0 to g - 1.
    draws : (b, g) int64
        Groups of each draw.
    """
    if np.isnan(ratios).all():
        return (float("nan"),) * 3
    by_group = [ratios[owners == group] for group in range(int(owners.max()) + 1)]
    largest = max(len(part) for part in by_group)
    padded = np.array([np.pad(part, (0, largest - len(part)), constant_values=np.nan) for part in by_group])
    drawn = padded[draws].reshape(len(draws), -1)
    known = ~np.isnan(drawn).all(axis=1)
    low, high = np.percentile(np.nanmedian(drawn[known], axis=1), CENTRAL)
    return float(np.nanmedian(ratios)), float(low), float(high)


def verdict(interval: tuple[float, float, float], failed: float) -> float:
    """Return 1 for an interval under .98, -1 for one over 1.02, else 0; NaN where a unit failed."""
    _, low, high = interval
    if failed or np.isnan(low):
        return float("nan")
    return 1.0 if high < 1.0 - MARGIN else -1.0 if low > 1.0 + MARGIN else 0.0
