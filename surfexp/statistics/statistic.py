"""Numbers about results of other stages: a small table, and the numbers that sum it up."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import ClassVar

from surfexp.contract.arrays import Floats


@dataclass(frozen=True, eq=False)
class Statistic:
    """Columns of one length, and the numbers that sum them up.

    Parameters
    ----------
    name : str
        What was examined or measured, for captions.
    columns : dict of str to (r,) or (r, 3) float64
        The table, a column each, or a value with the ends of its interval; NaN where there is no value.
        Without columns there are metrics alone.
    rows : tuple of str, optional
        Names of the r rows.
    metrics : dict of str to float
        What was found. A statistic that measures one solver's result hands on the solver's own.
    notes
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
    HANDED_ON: ClassVar[tuple[str, ...]] = ("solver",)
    """Inputs whose metrics stand among those of the statistic."""

    def __post_init__(self) -> None:
        lengths = {name: len(values) for name, values in self.columns.items()}
        if self.rows:
            lengths["rows"] = len(self.rows)
        if len(set(lengths.values())) > 1:
            raise ValueError(f"statistic {self.name!r} has columns of lengths {lengths}, they must be equal")
