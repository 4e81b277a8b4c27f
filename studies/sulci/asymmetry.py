"""Are sulci longer on one side? Tests, false positives and power of a table of lengths, by estimator."""

from __future__ import annotations

import numpy as np

from surfexp.contract.arrays import Floats
from surfexp.statistics.paired_tests import paired_tests, power_by_subjects, rate_in_halves

from .population_study import Table

LARGEST = 1e9
FEWEST_PAIRS = 3
PUBLISHED, WHOLE = "own region, published line", "own region, line with ends"


def measured(table: Table, sulci: int | None = None) -> tuple[Table, tuple[str, ...]]:
    """Return the estimators with enough complete pairs for a test, and a sentence for each of the others.

    Parameters
    ----------
    table : mapping
        By estimator and side (subjects, sulci) lengths.
    sulci : int, optional
        How many of the first ones count; default: all.

    Raises
    ------
    ValueError
        If no estimator has them.
    """
    kept, notes = {}, []
    for estimator, lengths in table.items():
        pairs = np.isfinite(lengths["left"] - lengths["right"])[:, :sulci].sum(axis=0)
        if pairs.min() >= FEWEST_PAIRS:
            kept[estimator] = lengths
        else:
            place = f"{pairs.min()} complete pairs of sulcus {pairs.argmin() + 1}"
            notes.append(f"{estimator} is left out: {place}, at least {FEWEST_PAIRS} are needed.")
    if not kept:
        least = ", ".join(note.split(" is left out")[0] for note in notes)
        raise ValueError(
            f"no estimator ({least}) has {FEWEST_PAIRS} pairs of lengths in every sulcus: take at least {FEWEST_PAIRS} "
            "subjects with both sides"
        )
    return kept, tuple(notes)


def asymmetry_study(
    table: Table, draws: int = 200, seed: int = 0
) -> tuple[tuple[str, ...], dict[str, Floats], dict[str, float]]:
    """Return names of rows (estimator and sulcus), columns of the paired tests, and metrics of the first sulcus.

    Parameters
    ----------
    table : mapping
        By estimator and side (subjects, sulci) lengths.
    draws : int
        Random halves of the subjects, for the share in which a difference is found.
    """
    rows: list[str] = []
    columns: dict[str, list[float]] = {}
    metrics: dict[str, float] = {}
    for estimator, lengths in measured(table)[0].items():
        count = lengths["left"].shape[1]
        sides = [{f"sulcus {k + 1}, {estimator}": lengths[side][:, k] for k in range(count)} for side in lengths]
        differences = lengths["left"] - lengths["right"]
        tests = paired_tests(sides[0], sides[1])
        rows += tests.names
        for name, values in vars(tests).items():
            if name != "names":
                columns.setdefault(name, []).extend(np.nan_to_num(values, posinf=LARGEST, neginf=-LARGEST))
        rates = [rate_in_halves(differences[:, k], draws, seed=seed) for k in range(count)]
        metrics |= {
            f"difference, {estimator}": float(tests.difference[0]),
            f"effect, {estimator}": float(np.clip(tests.effect[0], -LARGEST, LARGEST)),
            f"p, {estimator}": float(tests.p_t_holm[0]),
            f"p Wilcoxon, {estimator}": float(tests.p_wilcoxon_holm[0]),
            f"least p elsewhere, {estimator}": float(tests.p_t_holm[1:].min()) if count > 1 else 1.0,
            f"found in halves, {estimator}": float(np.mean(rates)),
            f"length, {estimator}": float(np.nanmean([lengths["left"][:, 0], lengths["right"][:, 0]])),
            f"pairs, {estimator}": float(tests.subjects[0]),
        }
    if all(f"length, {name}" in metrics for name in (PUBLISHED, WHOLE)):
        metrics["published share of line"] = metrics[f"length, {PUBLISHED}"] / metrics[f"length, {WHOLE}"]
    return tuple(rows), {name: np.array(values) for name, values in columns.items()}, metrics


def power_study(table: Table, sizes: list[int], draws: int = 200, seed: int = 0) -> dict[str, Floats]:
    """Return the column "subjects" and, by estimator, the share of samples of that many in which sulcus 1 differs."""
    columns = {"subjects": np.array(sizes, dtype=np.float64)}
    for estimator, lengths in measured(table, 1)[0].items():
        differences = (lengths["left"] - lengths["right"])[:, 0]
        columns[estimator] = power_by_subjects(differences, sizes, draws, seed=seed)
    return columns
