"""A person's run at rest on fsaverage5, from the files that brainspace carries: maps of connectivity from parts of it."""

from __future__ import annotations

from dataclasses import replace
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from surfexp.anatomy.conte69 import SIDES
from surfexp.anatomy.data_packages import BRAINSPACE, RUN
from surfexp.anatomy.fsaverage5 import fsaverage5
from surfexp.contract.arrays import Floats, Integers
from surfexp.io.freesurfer import read_volume_map
from surfexp.mesh.masked_surface import cut_to_mask
from surfexp.mesh.surface import Surface

VERTICES = 10_242
BLOCK, GAP = 40, 10
PARTS = 3
ROUNDING = 1e-9


def resting_run(hemisphere: str) -> tuple[Floats, Floats]:
    """Return (10242, 652) values of a run at rest and (652, 29) confounds that were measured beside it.

    Raises
    ------
    MissingExtra
        If brainspace is not installed.
    """
    series = read_volume_map(BRAINSPACE.file(f"{RUN}.fsa5.{SIDES[hemisphere]}.mgz"))
    return series, np.loadtxt(BRAINSPACE.file(f"{RUN}_confounds.txt"))


def resting_fsaverage5(hemisphere: Literal["left", "right"] = "left", sheet: str = "white") -> Surface:
    """Return fsaverage5 where a run at rest varies and the cortex has a thickness, in mm; needs brainspace.

    Raises
    ------
    MissingExtra
        If brainspace or nilearn is not installed.
    """
    whole = replace(fsaverage5(hemisphere, sheet), hemisphere=hemisphere)
    varies = np.ptp(resting_run(hemisphere)[0], axis=1) > 0
    return cut_to_mask(whole, varies & (whole.scalars["thickness"] > 0))


def run_on(surface: Surface) -> tuple[Floats, Floats]:
    """Return the run on the vertices of a part of fsaverage5, and the confounds.

    Raises
    ------
    ValueError
        If the surface is not a part of fsaverage5 whose side is known.
    """
    if surface.hemisphere not in SIDES or surface.part is None or surface.part.whole_count != VERTICES:
        raise ValueError(
            f"the run is known on parts of fsaverage5, not on {surface.name}: take surface=resting_fsaverage5"
        )
    series, confounds = resting_run(surface.hemisphere)
    return np.asarray(surface.part.restrict(series)), confounds


def frames_of_parts(frames: int, parts: int = PARTS, block: int = BLOCK, gap: int = GAP) -> list[Integers]:
    """Return the frames of each part: blocks dealt out in turn, with gaps between them that belong to none.

    Raises
    ------
    ValueError
        If there are fewer blocks than parts.
    """
    starts = range(0, frames - block + 1, block + gap)
    if len(starts) < parts:
        raise ValueError(f"{frames} frames have {len(starts)} blocks of {block}, at least {parts} are needed")
    return [
        np.concatenate([np.arange(start, start + block) for start in list(starts)[part::parts]])
        for part in range(parts)
    ]


def connectivity_maps(series: Floats, confounds: Floats, patch: NDArray[np.bool_]) -> Floats:
    """Return (n, 3) maps of the correlation with the mean of a patch, Fisher's z, from three parts of a run.

    Parameters
    ----------
    series : (n, frames) float64
    confounds : (frames, c) float64
        They and a constant are regressed out of each part by itself.
    patch : (n,) bool

    Raises
    ------
    ValueError
        If a vertex does not vary, or nothing is left of the patch.
    """
    if not patch.any():
        raise ValueError("the patch has no vertex, at least 1 is needed")
    maps = []
    for frames in frames_of_parts(series.shape[1]):
        design = np.column_stack([np.ones(len(frames)), confounds[frames]])
        left = series[:, frames] - (design @ np.linalg.lstsq(design, series[:, frames].T, rcond=None)[0]).T
        norms = np.linalg.norm(left, axis=1)
        still = norms <= ROUNDING * np.linalg.norm(series[:, frames], axis=1)
        if still.any():
            raise ValueError(f"{int(still.sum())} of {len(norms)} vertices do not vary: cut them away by a mask")
        mean = left[patch].mean(axis=0)
        maps.append(np.arctanh(np.clip(left @ mean / (norms * np.linalg.norm(mean)), -0.999, 0.999)))
    return np.column_stack(maps)
