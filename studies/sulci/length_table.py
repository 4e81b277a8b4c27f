"""The table of sulcal lengths: a row for each subject, side and sulcus, a column for each estimator, and back."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence

import numpy as np

from surfexp.contract.arrays import Floats
from surfexp.populations.synthetic_subject import SIDES

from .population_study import Table

KEYS = ("subject", "side", "sulcus")


def length_columns(
    table: Table, subjects: Sequence[int], names: Sequence[str] = ()
) -> tuple[tuple[str, ...], dict[str, Floats]]:
    """Return names of rows, and columns: subject, side (0 left, 1 right), sulcus from 1, then the lengths by estimator.

    Parameters
    ----------
    table : mapping
        By estimator and side (subjects, sulci) lengths, NaN where none was found.
    subjects : sequence of int
        Their numbers.
    names : sequence of str
        What rows call them; default: "subject" and the number.
    """
    called = dict(zip(subjects, names or [f"subject {number}" for number in subjects], strict=True))
    count = next(iter(table.values()))[SIDES[0]].shape[1]
    keys = [(number, side, sulcus) for number in subjects for side in range(2) for sulcus in range(1, count + 1)]
    rows = tuple(f"{called[number]}, {SIDES[side]}, sulcus {sulcus}" for number, side, sulcus in keys)
    columns = {name: np.array([key[k] for key in keys], dtype=np.float64) for k, name in enumerate(KEYS)}
    for estimator, parts in table.items():
        columns[estimator] = np.stack([parts[side] for side in SIDES], axis=1).ravel()
    return rows, columns


def table_of(parts: Iterable[Mapping[str, Floats]]) -> Table:
    """Return by estimator and side the (subjects, sulci) lengths of several tables by `length_columns`, one after another.

    Raises
    ------
    ValueError
        If a subject, side and sulcus is there twice or not at all, or the tables have different columns.
    """
    tables = list(parts)
    if not tables or any(list(table) != list(tables[0]) for table in tables):
        names = [", ".join(table) for table in tables]
        raise ValueError(f"{len(tables)} tables of lengths have the columns {names}: take tables made alike")
    columns = {name: np.concatenate([table[name] for table in tables]) for name in tables[0]}
    missing = [name for name in KEYS if name not in columns]
    if missing:
        raise ValueError(f"column {missing[0]!r} is missing, the table has {', '.join(columns)}")
    order = np.lexsort([columns[name] for name in reversed(KEYS)])
    subjects, count = np.unique(columns["subject"]), int(columns["sulcus"].max())
    expected = np.array([(a, b, c) for a in subjects for b in (0.0, 1.0) for c in range(1, count + 1)])
    found = np.stack([columns[name][order] for name in KEYS], axis=1)
    if found.shape != expected.shape or (found != expected).any():
        shape = f"{len(subjects)} subjects, 2 sides and {count} sulci"
        raise ValueError(f"{len(found)} rows do not list {shape} once each, {len(expected)} rows are needed")
    return {
        name: {side: values[order].reshape(len(subjects), 2, count)[:, k] for k, side in enumerate(SIDES)}
        for name, values in columns.items()
        if name not in KEYS
    }


def chosen(table: Table, estimators: Sequence[str]) -> Table:
    """Return the named estimators of a table, all where none is named."""
    unknown = [name for name in estimators if name not in table]
    if unknown:
        raise ValueError(f"estimator {unknown[0]!r} is unknown, choose from {', '.join(table)}")
    return {name: table[name] for name in estimators or table}
