"""Surfaces with their maps, labels and mask, from files."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from surfexp.mesh.surface import BOTH, Surface
from surfexp.tasks.both_files import read_both, with_files_of_both
from surfexp.tasks.stored_surface import stored_surface
from surfexp.tasks.surface_file import PathLike, read_surface, sound_or_repaired


def read(
    path: PathLike | None = None,
    *,
    left: PathLike | None = None,
    right: PathLike | None = None,
    maps: Mapping[str, Any] | PathLike | Sequence[Any] | None = None,
    labels: Mapping[str, Any] | PathLike | Sequence[Any] | None = None,
    mask: PathLike | np.ndarray | Mapping[str, Any] | None = None,
    unit: str = "",
    hemisphere: str = "",
    repair: bool = False,
) -> Surface:
    """Read a surface, or both hemispheres as one surface, with its maps, labels and mask.

    With `left` and `right`, or an .npz of both, each map, the labels and the mask are a pair {"left": file, "right": file}, or
    one file that holds both: .dscalar.nii, .dlabel.nii, .npz. The left vertices stand first, and what has one name has one
    label.

    Parameters
    ----------
    path : path
        OFF, OBJ, PLY, STL, VTK (.vtk, .vtp, .vtu), GIFTI, npz, FreeSurfer geometry, .vert/.tri. An .npz that `write` made also
        has mask, labels, unit and both hemispheres; what is given here replaces what it has under the same name.
    left, right : path, optional
        The two hemispheres, in place of `path`.
    maps : path, list of paths, or dict of name to path, optional
        GIFTI, CIFTI-2, .mgh/.mgz, FreeSurfer curvature, .npy/.npz, .csv, text. A map without a name is called as its file. A
        file with several maps gives each its own name.
    labels : path, list of paths, or dict of name to path, optional
        .label.gii, .annot, .dlabel.nii.
    mask : path or (n,) array, optional
        A FreeSurfer .label, named labels (all but unknown and medial wall, or `FILE:NAME,NAME`), or a map that is 0 outside.
    unit : str
        Unit of length; mm if not given and the file names a scanner's space (FreeSurfer) or a structure of the brain (GIFTI).
    hemisphere : {"", "left", "right"}
        Taken from the files where they say so; files of both hemispheres are refused. What is given here overrides them.
    repair : bool
        Repair a defective mesh instead of refusing it, with a note for each change. The numbering of the file stays: vertices
        without a face are outside, and copies of vertices that are split stand behind all others. Vertices without faces or
        position are no defect.

    Returns
    -------
    Surface

    Raises
    ------
    ValueError
        If a file cannot be read, does not fit, or the mesh has a defect that a method cannot work with.

    Examples
    --------
    >>> import surfexp as sx
    >>> sx.write("ball.ply", sx.shape("icosphere", levels=2))
    >>> len(sx.read("ball.ply").mesh.faces)
    320
    >>> sx.write("height.csv", sx.shape("icosphere", levels=2).mesh.vertices[:, 2])
    >>> list(sx.read("ball.ply", maps="height.csv").scalars)
    ['height']
    >>> brain = sx.read(left="ball.ply", right="ball.ply", maps={"height": {"left": "height.csv", "right": "height.csv"}})
    >>> brain.hemisphere, len(brain.scalars["height"]), int(brain.right.sum())
    ('both', 324, 162)
    """
    if left is not None or right is not None or path is None:
        if path is not None or hemisphere:
            raise ValueError("left and right name both hemispheres: give them alone, or path")
        return read_both(left, right, maps, labels, mask, unit, repair)
    if not isinstance(path, str | Path):
        raise ValueError(f"path is a {type(path).__name__}, one file is needed; both hemispheres are left= and right=")
    if Path(path).suffix.lower() == ".npz" and not hemisphere and Path(path).is_file():
        both = stored_surface(path)
        if both.hemisphere == BOTH:
            both = with_files_of_both(replace(both, unit=unit or both.unit), maps, labels, mask)
            return sound_or_repaired(both, path, repair)
    return read_surface(path, maps=maps, labels=labels, mask=mask, unit=unit, hemisphere=hemisphere, repair=repair)
