"""Does the usual solver return all the lowest eigenpairs? Its runs against a spectrum that is proved complete."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from scipy.sparse import csr_array
from scipy.sparse.linalg import ArpackError, LinearOperator, eigsh, splu
from scipy.stats import binomtest

from surfexp.contract.arrays import Floats
from surfexp.contract.member import Member
from surfexp.operators.assembly import mass_matrix, stiffness
from surfexp.operators.surface_operator import SurfaceOperator
from surfexp.spectrum.eigensystem import EigenSystem
from surfexp.statistics.statistic import Statistic

SHIFT = -0.01
CLOSE = 1e-6
NAMES = ("runs", "runs_with_missing", "runs_with_surplus", "runs_without_result")
LARGEST = ("missing", "value_error", "span_sine")


def missing_pairs(
    operator: SurfaceOperator, certified: EigenSystem, counts: Sequence[int] = (50, 100), seeds: int = 3
) -> Statistic:
    """Run ARPACK as LaPy and neuromodes call it, and count what it leaves out.

    The call is that of both: shift-invert about -0.01 by SuperLU, tolerance 0 (rounding), k values nearest to the
    shift, a start vector drawn uniformly from [-1, 1].

    Parameters
    ----------
    operator : SurfaceOperator
    certified : EigenSystem
        Proved complete, with more pairs than the largest count.
    counts : sequence of int
        Numbers of pairs that are asked for.
    seeds : int
        Start vectors for each.

    Returns
    -------
    Statistic
        Columns, a row a run: count, seed, missing, surplus, value_error, span_sine. `missing` is the largest number of
        certified values below a returned one, less those returned below it; `surplus` the opposite. A run without
        result has NaN there.

    Raises
    ------
    ValueError
        If the certified spectrum is not complete, or not longer than the largest count.
    """
    if not certified.complete or len(certified.values) <= max(counts):
        raise ValueError(
            f"the certified spectrum has {len(certified.values)} values, complete {certified.complete}; more than "
            f"{max(counts)} are needed, proved complete"
        )
    stiff, mass = stiffness(operator), mass_matrix(operator)
    rows: list[tuple[float, ...]] = []
    try:
        factor = splu((stiff - SHIFT * mass).tocsc())
        inverse = LinearOperator(stiff.shape, matvec=factor.solve, dtype=np.float64)
    except RuntimeError:
        inverse = None
    for count in counts:
        for seed in range(seeds):
            start = np.random.default_rng(seed).uniform(-1.0, 1.0, stiff.shape[0])
            try:
                if inverse is None:
                    raise ArpackError(-9, {-9: "the factorisation failed"})
                values, vectors = eigsh(stiff, count, mass, sigma=SHIFT, OPinv=inverse, v0=start)
            except ArpackError:
                rows.append((count, seed, np.nan, np.nan, np.nan, np.nan))
                continue
            rows.append((count, seed, *compared(values, vectors, certified, mass)))
    table = np.array(rows, dtype=np.float64).T
    names = ("count", "seed", "missing", "surplus", "value_error", "span_sine")
    return Statistic("eigenpairs left out", dict(zip(names, table, strict=True)), metrics=_summed(table))


def compared(
    values: Floats, vectors: Floats, certified: EigenSystem, mass: csr_array
) -> tuple[float, float, float, float]:
    """Return how many pairs are missing and how many too many, the largest error of a value, and of the span.

    A value counts as below another one if it is so by more than 1e-6 of it and of the mean distance of eigenvalues.
    """
    order = np.argsort(values)
    values, vectors = values[order], vectors[:, order]
    close = CLOSE * (np.abs(values) + certified.spacing)
    places = np.arange(len(values))
    missing = np.searchsorted(certified.values, values - close) - places
    surplus = places + 1 - np.searchsorted(certified.values, values + close)
    nearest = np.abs(values[:, None] - certified.values[None]).min(axis=1)
    error = (nearest / (np.abs(values) + certified.spacing)).max()
    rest = vectors - certified.vectors @ (certified.vectors.T @ (mass @ vectors))
    inside = values < certified.values[-1] - close
    sines = np.sqrt(np.maximum((rest * (mass @ rest)).sum(axis=0), 0.0))
    sine = sines[inside].max(initial=0.0)
    return float(max(missing.max(), 0)), float(max(surplus.max(), 0)), float(error), float(sine)


def _summed(table: Floats) -> dict[str, float]:
    _, _, missing, surplus, errors, sines = table
    known = np.isfinite(missing)
    return {
        "runs": float(len(missing)),
        "runs_with_missing": float((missing[known] > 0).sum()),
        "runs_with_surplus": float((surplus[known] > 0).sum()),
        "runs_without_result": float((~known).sum()),
        "missing": float(missing[known].max(initial=0.0)),
        "value_error": float(errors[known].max(initial=0.0)),
        "span_sine": float(sines[known].max(initial=0.0)),
    }


def missing_by_kind(statistics: Mapping[Member, Statistic]) -> Statistic:
    """Count runs that leave an eigenpair out over all meshes of a kind, with the interval of Clopper and Pearson at 95 %.

    Parameters
    ----------
    statistics : mapping of Member to Statistic
        Of `missing_pairs`; the class of a member is its kind.

    Returns
    -------
    Statistic
        Rows: the kinds, and all. Columns: meshes, runs, runs with a missing pair, their share in per cent with the ends
        of its interval, runs with a pair too many, runs without a result, largest errors of a value and of the span.
    """
    kinds = list(dict.fromkeys(member.class_name for member in statistics))
    groups = {kind: [found for member, found in statistics.items() if member.class_name == kind] for kind in kinds}
    groups["all"] = list(statistics.values())
    rows = [_of_kind(found) for found in groups.values()]
    columns = {name: np.array([row[name] for row in rows]) for name in rows[0]}
    metrics = {name: float(columns[name][-1]) for name in ("meshes", *NAMES, *LARGEST)}
    missing = columns["runs_with_missing"].tolist()
    metrics |= {f"runs_with_missing {kind}": number for kind, number in zip(groups, missing, strict=True)}
    share, _, highest = columns["missing_share"][-1].tolist()
    metrics |= {"missing_share": share, "missing_share_highest": highest}
    return Statistic("eigenpairs left out, by kind of mesh", columns, tuple(groups), metrics)


def _of_kind(found: Sequence[Statistic]) -> dict[str, float | list[float]]:
    """Sums, the share with its interval, and largest errors."""
    totals = {name: sum(item.metrics[name] for item in found) for name in NAMES}
    test = binomtest(int(totals["runs_with_missing"]), int(totals["runs"]))
    interval = test.proportion_ci(0.95, method="exact")
    share = [100.0 * test.statistic, 100.0 * interval.low, 100.0 * interval.high]
    largest = {name: max(item.metrics[name] for item in found) for name in LARGEST}
    return {"meshes": float(len(found)), **totals, "missing_share": share, **largest}
