"""Denoising where the map itself says by what."""

from __future__ import annotations

from surfexp.contract.arrays import Floats
from surfexp.mesh.surface import Surface
from surfexp.mesh.surface_part import SurfacePart
from surfexp.operators.surface_operator import SurfaceOperator
from surfexp.smoothing.automatic import automatic_smoothing
from surfexp.tasks.denoised_map import DenoisedMap


def automatically_denoised(
    owner: Surface, part: SurfacePart, operator: SurfaceOperator, image: Floats, noise: float, estimated: bool
) -> DenoisedMap:
    """Denoise a map by the method and the parameter that promise the least error.

    Parameters
    ----------
    owner : Surface
    part : SurfacePart
        Of the owner.
    operator : SurfaceOperator
        On the part.
    image : (p,) float64
    noise : float
        Standard deviation.
    estimated : bool
        Whether the noise was.

    Raises
    ------
    ValueError
        If the map has several channels.
    """
    if image.ndim > 1:
        raise ValueError(f"auto takes one channel, the map has {image.shape[1]}: denoise each by itself")
    found = automatic_smoothing(part.mesh, operator, image, noise)
    facts = {
        "noise": noise,
        "noise_estimated": estimated,
        "chosen": found.method,
        "parameter": found.parameter,
        **{f"risk_{name}": risk for name, risk in found.risk.items()},
        "relative_gap": found.largest_gap,
        "converged": found.converged,
    }
    notes = part.notes
    if found.at_the_end:
        notes += (
            "The parameter is an end of its grid. Where the noise itself is smooth, no estimate from one map sees it: choose "
            "the width by a second measurement.",
        )
    return DenoisedMap(part.extend(found.values), "auto", facts, notes)
