"""A feature function: one number at each vertex, whose level sets make a skeleton."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from surfexp.contract.arrays import Floats


@dataclass(frozen=True, eq=False)
class Feature:
    """A function on the vertices of a surface.

    Parameters
    ----------
    values : (n,) float64
        Finite.
    name : str
        What a caption calls it.
    unit : str
        Empty when it has none.
    metrics, notes
        As in `Surface`.

    Raises
    ------
    ValueError
        If it is not a vector of finite numbers.
    """

    values: Floats
    name: str = "feature"
    unit: str = ""
    metrics: dict[str, float] = field(default_factory=dict)
    notes: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        if np.ndim(self.values) != 1:
            raise ValueError(f"feature {self.name!r} has shape {np.shape(self.values)}, expected one number a vertex")
        bad = int((~np.isfinite(self.values)).sum())
        if bad:
            raise ValueError(f"feature {self.name!r} has {bad} values of {len(self.values)} that are not finite")


def checked_feature(values: Floats, vertex_count: int) -> Floats:
    """Return the values as float64, refused unless there is one finite number for each vertex and they differ.

    Raises
    ------
    ValueError
        If the length is another, a value is not finite, or all are equal.
    """
    checked = np.ascontiguousarray(values, dtype=np.float64)
    if checked.shape != (vertex_count,):
        raise ValueError(f"the feature has shape {checked.shape}, the mesh has {vertex_count} vertices")
    Feature(checked)
    if checked.min() == checked.max():
        raise ValueError(f"the feature is {checked[0]:g} at every vertex, it has no level sets: choose another one")
    return checked
