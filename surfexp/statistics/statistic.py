"""A small table of numbers with what follows from it."""

from __future__ import annotations

from dataclasses import dataclass, field

from surfexp.contract.arrays import Floats


@dataclass(frozen=True, eq=False)
class Statistic:
    """Columns of one length, and the numbers that sum them up.

    Parameters
    ----------
    name : str
        What was examined, for captions.
    columns : dict of str to (r,) or (r, 3) float64
        The table, a column each, or a value with the ends of its interval; NaN where there is no value.
    rows : tuple of str, optional
        Names of the r rows.
    metrics, notes
        As in `Surface`.

    Raises
    ------
    ValueError
        If columns or rows have different lengths.
    """

    name: str
    columns: dict[str, Floats] = field(default_factory=dict, metadata={"nan": True})
    rows: tuple[str, ...] = ()
    metrics: dict[str, float] = field(default_factory=dict)
    notes: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        lengths = {name: len(values) for name, values in self.columns.items()}
        if self.rows:
            lengths["rows"] = len(self.rows)
        if len(set(lengths.values())) > 1:
            raise ValueError(f"statistic {self.name!r} has columns of lengths {lengths}, they must be equal")
