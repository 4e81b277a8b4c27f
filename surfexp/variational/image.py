"""An image on a surface: values at the vertices, with the truth where it is known."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from surfexp.contract.arrays import Floats


@dataclass(frozen=True, eq=False)
class Image:
    """Values at the vertices of a surface.

    Parameters
    ----------
    values : (n,) or (n, c) float64
        The observed image, one or several channels.
    name, unit : str
        For captions and colour bars ("mean curvature", "1/mm").
    clean : like `values`, optional
        The image before noise, blur or loss.
    noise : float
        Standard deviation of the Gaussian noise that was added, 0 when unknown.
    known : (n,) bool, optional
        Where the image was observed; None means everywhere.
    labels : dict of str to (n,) bool
        Reference segmentations.
    metrics, notes
        As in `Surface`.

    Raises
    ------
    ValueError
        If values are not finite or lengths differ.
    """

    values: Floats
    name: str = "image"
    unit: str = ""
    clean: Floats | None = None
    noise: float = 0.0
    known: NDArray[np.bool_] | None = None
    labels: dict[str, NDArray[np.bool_]] = field(default_factory=dict)
    metrics: dict[str, float] = field(default_factory=dict)
    notes: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        n = len(self.values)
        bad = int((~np.isfinite(self.values)).sum())
        if bad:
            raise ValueError(f"image {self.name!r} has {bad} values of {self.values.size} that are not finite")
        companions = {"clean": self.clean, "known": self.known} | {f"label {k!r}": v for k, v in self.labels.items()}
        for name, array in companions.items():
            if array is not None and len(array) != n:
                raise ValueError(f"{name} has {len(array)} entries, image {self.name!r} has {n}")
