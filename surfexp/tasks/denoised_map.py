"""A map without its noise, with what is proved of it."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np

from surfexp.contract.arrays import Floats, Integers
from surfexp.contract.drawable import Drawable
from surfexp.contract.summary import Summary
from surfexp.mesh.surface_part import SurfacePart
from surfexp.variational.solution import Solution


@dataclass(frozen=True, eq=False)
class Evidence:
    """All that a duality gap is computed from, inside the mask.

    Parameters
    ----------
    part : SurfacePart
        Vertices and faces inside the mask.
    map : (p,) or (p, c) float64
        Before denoising.
    solution : Solution
        Its values and dual field.
    slopes : (e, 2) float64
        Those of "tgv" along and across each edge; of "rof" none.
    tolerance : float
        Largest relative gap that was asked for.
    """

    part: SurfacePart
    map: Floats
    solution: Solution
    slopes: Floats
    tolerance: float


@dataclass(frozen=True, eq=False, repr=False)
class DenoisedMap(Drawable):
    """A map without its noise.

    Parameters
    ----------
    values : (n,) or (n, c) float64
        NaN outside the mask.
    method : str
        "rof", "tgv", "auto" or "heat".
    certificate : dict
        What is proved and with which parameters: `relative_gap` and `error_bound` for ROF and TGV.
    notes : tuple of str
    name : str
        Under which the surface carries the map that it was made of; what a file calls it.
    outliers : (k,) int64
        Vertices whose values "auto" replaced before, far from those of all their neighbours.
    evidence : Evidence, optional
        Of "rof" and "tgv": what `proof_page` shows.
    given : (n,) or (n, c) float64, optional
        The map before; NaN outside the mask.
    """

    values: Floats
    method: str
    certificate: dict[str, Any] = field(default_factory=dict)
    notes: tuple[str, ...] = ()
    name: str = "map"
    outliers: Integers = field(default_factory=lambda: np.empty(0, dtype=np.int64))
    evidence: Evidence | None = None
    given: Floats | None = None

    def _summary(self) -> Summary:
        known = np.isfinite(self.values)
        facts = {
            "known values": int(known.sum()),
            "least": float(self.values[known].min()) if known.any() else None,
            "largest": float(self.values[known].max()) if known.any() else None,
            **{name.replace("_", " "): value for name, value in self.certificate.items()},
        }
        return Summary(f"map after {self.method}", facts, self.notes)
