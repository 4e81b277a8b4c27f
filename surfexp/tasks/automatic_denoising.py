"""Denoising where the map itself says by what."""

from __future__ import annotations

from surfexp.contract.arrays import Floats
from surfexp.mesh.surface_part import SurfacePart
from surfexp.operators.surface_operator import SurfaceOperator
from surfexp.smoothing.automatic import automatic_smoothing
from surfexp.tasks.denoised_map import DenoisedMap
from surfexp.variational.noise_reading import read_noise, without_outliers


def automatically_denoised(
    part: SurfacePart, operator: SurfaceOperator, image: Floats, noise: float | None
) -> DenoisedMap:
    """Denoise a map by the method and the parameter that promise the least error, its outliers replaced before.

    Stein's estimate holds for Gaussian noise: a few outliers make it choose what keeps them. Each is replaced by the median
    of its neighbours, as `without_outliers` does, and listed.

    Parameters
    ----------
    part : SurfacePart
    operator : SurfaceOperator
        On the part.
    image : (p,) float64
    noise : float, optional
        Standard deviation; read from the map if not given.

    Raises
    ------
    ValueError
        If the map has several channels.
    """
    if image.ndim > 1:
        raise ValueError(f"auto takes one channel, the map has {image.shape[1]}: denoise each by itself")
    read = read_noise(operator, image)
    clean = without_outliers(operator, image, read.outliers)
    level = read_noise(operator, clean).level if noise is None else noise
    found = automatic_smoothing(part.mesh, operator, clean, level)
    facts = {
        "noise": level,
        "noise_estimated": noise is None,
        "outliers": len(read.outliers),
        "chosen": found.method,
        "parameter": found.parameter,
        **{f"risk_{name}": risk for name, risk in found.risk.items()},
        "relative_gap": found.largest_gap,
        "converged": found.converged,
    }
    notes = part.notes + read.notes
    if len(read.outliers):
        notes += (
            f"{len(read.outliers)} values far from all their neighbours were replaced by the median of these before: "
            "`outliers` lists them.",
        )
    if found.at_the_end:
        notes += (
            "The parameter is an end of its grid. Where the noise itself is smooth, no estimate from one map sees it: choose "
            "the width by a second measurement.",
        )
    places = part.vertices[read.outliers]
    return DenoisedMap(part.extend(found.values), "auto", facts, notes, outliers=places)
