"""The average human cortex fsaverage5, from the files that nilearn carries in its own package."""

from __future__ import annotations

from importlib.util import find_spec
from pathlib import Path
from typing import Literal, get_args

from surfexp.contract.arrays import Floats
from surfexp.extras import MissingExtra, missing_line
from surfexp.io.gifti import read_gifti_arrays
from surfexp.mesh.both_hemispheres import joined
from surfexp.mesh.shape_metrics import with_metrics
from surfexp.mesh.surface import Surface
from surfexp.mesh.triangle_mesh import TriangleMesh

Hemisphere = Literal["left", "right", "both"]
SHEETS = {"pial": "pial", "white": "white", "inflated": "infl", "sphere": "sphere"}
MAPS = {"sulc": "sulc", "curv": "curv", "thickness": "thick", "area": "area"}


def fsaverage5(hemisphere: Hemisphere = "left", sheet: str = "pial") -> Surface:
    """One hemisphere of fsaverage5 (Fischl et al. 1999), 10,242 vertices, closed, genus 0, in mm; or both as one surface.

    Parameters
    ----------
    hemisphere : "left", "right" or "both"
    sheet : "pial", "white", "inflated" or "sphere"
        All four share their faces, so maps carry over.

    Returns
    -------
    Surface
        With the scalar maps "sulc" (positive in sulci), "curv" (mean curvature, 1/mm, positive in sulci),
        "thickness" (mm) and "area" (mm^2).

    Raises
    ------
    ValueError
        If hemisphere or sheet is unknown, or nilearn's files are not there.
    """
    if hemisphere not in get_args(Hemisphere):
        raise ValueError(f"hemisphere {hemisphere!r} is unknown, choose left, right or both")
    if sheet not in SHEETS:
        raise ValueError(f"sheet {sheet!r} of fsaverage5 is unknown, choose one of {', '.join(SHEETS)}")
    if hemisphere == "both":
        return joined(fsaverage5("left", sheet), fsaverage5("right", sheet), f"fsaverage5 {sheet}")
    vertices, faces = read_gifti_arrays(_packaged(f"{SHEETS[sheet]}_{hemisphere}"))
    scalars = {name: _map(f"{stem}_{hemisphere}") for name, stem in MAPS.items()}
    name = f"fsaverage5 {sheet}, {hemisphere}"
    return with_metrics(Surface(TriangleMesh(vertices, faces), name, "mm", scalars, hemisphere=hemisphere))


def _map(stem: str) -> Floats:
    return read_gifti_arrays(_packaged(stem))[0].astype(float)


def _packaged(stem: str) -> Path:
    # found without importing nilearn, whose import takes seconds
    package = find_spec("nilearn")
    if package is None or package.origin is None:
        raise MissingExtra(missing_line("fsaverage5", ["nilearn"]))
    path = Path(package.origin).parent / "datasets" / "data" / "fsaverage5" / f"{stem}.gii.gz"
    if not path.is_file():
        raise ValueError(f"nilearn's file {path.name} is missing from {path.parent}: reinstall nilearn 0.13.1")
    return path
