"""The average cortex conte69 on the fsLR mesh, with measured maps, from the files that brainspace carries."""

from __future__ import annotations

import numpy as np

from surfexp.anatomy.data_packages import BRAINSPACE, MAPS, SURFACES
from surfexp.contract.arrays import Floats
from surfexp.io.gifti import read_gifti_arrays
from surfexp.mesh.masked_surface import cut_to_mask
from surfexp.mesh.shape_metrics import with_metrics
from surfexp.mesh.surface import Surface
from surfexp.mesh.triangle_mesh import TriangleMesh

SIDES = {"left": "lh", "right": "rh"}
SHEETS = {"midthickness": "", "sphere": "_sphere"}
MAP_NAMES = ("thickness", "t1wt2w", "curvature", "fc_gradient0", "fc_gradient1", "mpc_gradient0", "mpc_gradient1")
WHOLE = 32_492


def conte69(hemisphere: str = "left", sheet: str = "midthickness") -> Surface:
    """Return one hemisphere of conte69 without its medial wall, some 29,300 of 32,492 vertices, in mm; needs brainspace.

    Parameters
    ----------
    hemisphere : "left" or "right"
    sheet : "midthickness" or "sphere"
        Both share their faces.

    Returns
    -------
    Surface
        With the maps "thickness" (mm), "t1wt2w" (ratio of two contrasts, myelin), "curvature" (1/mm), "fc_gradient0" and
        "fc_gradient1" (gradients of functional connectivity), "mpc_gradient0" and "mpc_gradient1" (of the profiles of the
        cortical layers): means over people of the Human Connectome Project.

    Raises
    ------
    ValueError
        If hemisphere or sheet is unknown, or a file is another one than was seen.
    MissingExtra
        If brainspace is not installed.
    """
    if hemisphere not in SIDES or sheet not in SHEETS:
        raise ValueError(
            f"hemisphere is {hemisphere!r} and sheet {sheet!r}, choose {' or '.join(SIDES)} and {' or '.join(SHEETS)}"
        )
    side = SIDES[hemisphere]
    vertices, faces = read_gifti_arrays(BRAINSPACE.file(f"{SURFACES}/conte69_32k_{side}{SHEETS[sheet]}.gii"))
    mask = np.loadtxt(BRAINSPACE.file(f"{SURFACES}/conte69_32k_{side}_mask.csv")) > 0
    scalars = {name: conte69_map(name, hemisphere) for name in MAP_NAMES}
    whole = Surface(
        TriangleMesh(vertices, faces), f"conte69 {sheet}, {hemisphere}", "mm", scalars, hemisphere=hemisphere
    )
    return with_metrics(cut_to_mask(whole, mask))


def conte69_map(name: str, hemisphere: str) -> Floats:
    """(32492,) values of a map on one hemisphere; NaN over the medial wall."""
    both = np.loadtxt(BRAINSPACE.file(f"{MAPS}/conte69_32k_{name}.csv"))
    return np.asarray(both[:WHOLE] if hemisphere == "left" else both[WHOLE:])
