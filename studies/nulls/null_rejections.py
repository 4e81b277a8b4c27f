"""How often a correlation is called significant by null models, where there is none and where one was planted."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from surfexp.contract.arrays import Floats
from surfexp.contract.member import Member
from surfexp.nulls.kept import power_error, values_error, variogram_error
from surfexp.nulls.rejection import correlations, crossed_interval, p_values, parametric_p_values
from surfexp.operators.assembly import mass_matrix
from surfexp.statistics.statistic import Statistic

from .null_methods import METHODS, OneSurface, null_models

LEVEL = 0.05
# the protocol calls a method exact enough where its interval meets these
LOWEST, HIGHEST = 4.0, 6.0
ROWS = (*METHODS, "parametric")
ERRORS = ("power_error", "variogram_error", "values_error")


@dataclass(frozen=True)
class Design:
    """Which maps are paired.

    Parameters
    ----------
    maps : int
        Maps that get nulls; all further ones are their partners.
    nulls : int
        For each map.
    planted : sequence of float
        Correlations.
    planted_partners : int
        Partners that each map gets for every planted correlation.
    examined : int
        Maps of whose nulls it is measured what they have kept.
    seed : int
        Of the nulls; each map has its own that follows from it and the map's number.
    """

    maps: int = 50
    nulls: int = 199
    planted: Sequence[float] = (0.1, 0.2, 0.4)
    planted_partners: int = 20
    examined: int = 10
    seed: int = 0


def null_rejections(of: OneSurface, fields: Floats, design: Design) -> Statistic:
    """Test each of the first fields against each of the others, and against fields that were made to correlate with it.

    Correlations are over vertices, all counting the same, at the level of 5 %, two-sided. A partner with a planted correlation
    is r x + sqrt(1 - r^2) z with a partner z.

    Parameters
    ----------
    of : OneSurface
    fields : (n, c) float64
        Independent, of variance 1.
    design : Design

    Returns
    -------
    Statistic
        Rows: METHODS, and "parametric", Student's test of independent vertices. Columns: rejections with the ends of their
        interval (`crossed_interval`) and power for each planted correlation, in per cent; power_error, variogram_error,
        values_error and unknown, the share of NaN in per cent, as means over nulls of the examined maps (NaN for
        "parametric"). Metrics: the same by method, and exact_enough.

    Raises
    ------
    ValueError
        If there are fewer than 2 maps or 2 partners, or fewer partners than are planted or maps than are examined.
    """
    partners = fields[:, design.maps :]
    if design.maps < 2 or partners.shape[1] < max(2, design.planted_partners) or design.examined > design.maps:
        raise ValueError(
            f"{fields.shape[1]} fields are {design.maps} maps and {partners.shape[1]} partners, of which "
            f"{design.planted_partners} are planted and {design.examined} maps examined: 2 of each are needed, and these"
        )
    models = null_models(of)
    rejected = np.zeros((len(ROWS), design.maps, partners.shape[1]), dtype=bool)
    found = np.zeros((len(ROWS), design.maps, len(design.planted) * design.planted_partners), dtype=bool)
    kept: dict[str, list[Floats]] = {name: [] for name in models}
    for number in range(design.maps):
        values = fields[:, number]
        seed = int(np.random.SeedSequence([design.seed, number]).generate_state(1)[0])
        others = np.concatenate([partners, _planted(values, partners, design)], axis=1)
        observed = correlations(values[:, None], others)[0]
        significant = np.zeros((len(ROWS), others.shape[1]), dtype=bool)
        for row, (name, model) in enumerate(models.items()):
            nulls = model(values, design.nulls, seed)
            significant[row] = p_values(observed, correlations(nulls, others)) <= LEVEL
            if number < design.examined:
                kept[name].append(_kept(of, values, nulls))
        significant[-1] = parametric_p_values(observed, len(values)) <= LEVEL
        rejected[:, number], found[:, number] = np.split(significant, [partners.shape[1]], axis=1)
    return _summed(rejected, found, kept, design)


def _planted(values: Floats, partners: Floats, design: Design) -> Floats:
    """Partners with each planted correlation, one correlation after the other."""
    rest = partners[:, : design.planted_partners]
    return np.concatenate([r * values[:, None] + np.sqrt(1.0 - r**2) * rest for r in design.planted], axis=1)


def _kept(of: OneSurface, values: Floats, nulls: Floats) -> Floats:
    """Means over nulls of the three errors, and of the share that is unknown."""
    errors = (
        power_error(of.eigensystem.vectors, mass_matrix(of.operator), values, nulls),
        variogram_error(of.pairs, values, nulls),
        values_error(values, nulls),
        100.0 * np.isnan(nulls),
    )
    return np.array([error.mean() for error in errors])


def _summed(
    rejected: NDArray[np.bool_], found: NDArray[np.bool_], kept: Mapping[str, list[Floats]], design: Design
) -> Statistic:
    shares = 100.0 * np.array([crossed_interval(table) for table in rejected])
    columns: dict[str, Floats] = {"rejections": shares}
    for k, r in enumerate(design.planted):
        some = found[:, :, k * design.planted_partners : (k + 1) * design.planted_partners]
        columns[f"power {r:g}"] = 100.0 * some.mean(axis=(1, 2))
    means = np.full((len(ROWS), 4), np.nan)
    means[:-1] = [np.mean(kept[name], axis=0) for name in METHODS]
    columns |= dict(zip((*ERRORS, "unknown"), means.T, strict=True))
    metrics: dict[str, float] = {"pairs": float(rejected[0].size)}
    for row, name in enumerate(ROWS):
        value, low, high = shares[row].tolist()
        metrics |= {f"rejections {name}": value, f"lowest {name}": low, f"highest {name}": high}
        metrics[f"exact_enough {name}"] = float(low <= HIGHEST and high >= LOWEST)
        metrics |= {f"power {r:g} {name}": float(columns[f"power {r:g}"][row]) for r in design.planted}
        if name in kept:
            metrics |= {f"{error} {name}": float(columns[error][row]) for error in ERRORS}
    return Statistic("rejections by null models", columns, ROWS, metrics)


def rejections_by_length(statistics: Mapping[Member, Statistic], lengths: Sequence[float]) -> Statistic:
    """Collect rejections over correlation lengths, for a figure.

    Parameters
    ----------
    statistics : mapping of Member to Statistic
        Of `null_rejections`.
    lengths : sequence of float
        One for each.

    Returns
    -------
    Statistic
        Rows by increasing length. Columns: length, level (5 %), and each method with the ends of its interval.
    """
    order = np.argsort(lengths, kind="stable")
    tables = list(statistics.values())
    stacked = np.stack([tables[k].columns["rejections"] for k in order])
    columns = {"length": np.asarray(lengths, dtype=np.float64)[order], "level": np.full(len(order), 100.0 * LEVEL)}
    columns |= {name: stacked[:, row] for row, name in enumerate(ROWS)}
    metrics = {"lengths": float(len(order))}
    metrics |= {f"exact_lengths {name}": sum(t.metrics[f"exact_enough {name}"] for t in tables) for name in ROWS}
    return Statistic("rejections by correlation length", columns, metrics=metrics)
