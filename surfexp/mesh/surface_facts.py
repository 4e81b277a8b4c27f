"""What a file says of a surface beside its geometry and its maps."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from surfexp.mesh.label_map import LabelMap


@dataclass(frozen=True, eq=False)
class SurfaceFacts:
    """Unit, mask, labels and sides, as in `Surface`.

    Parameters
    ----------
    unit : str
    mask : (n,) bool, optional
    labels : dict of str to LabelMap
    right : (n,) bool, optional
        Of both hemispheres: which vertices are of the right one.
    """

    unit: str = ""
    mask: NDArray[np.bool_] | None = None
    labels: Mapping[str, LabelMap] = field(default_factory=dict)
    right: NDArray[np.bool_] | None = None
