"""What a map of a surface to another domain does to lengths, angles and the order of its points."""

from __future__ import annotations

import numpy as np

from surfexp.contract.arrays import Floats
from surfexp.mesh.triangle_mesh import TriangleMesh


def distortion(mesh: TriangleMesh, image: TriangleMesh, centre: Floats | None = None) -> dict[str, float]:
    """Return the distortion of the piecewise linear map between two meshes of the same faces.

    Parameters
    ----------
    mesh, image : TriangleMesh
        The surface and its image, a plane domain with z = 0 or a sphere.
    centre : (3,) float64, optional
        Centre of the sphere, for which a face is flipped when it is seen clockwise from outside; without it, when it is
        seen clockwise from above.

    Returns
    -------
    dict
        length_scale_spread : 99th over 1st area-weighted percentile of sqrt(image area / area);
        length_scale_ratio : largest over smallest of it;
        flipped_faces : number of faces whose orientation is turned;
        angle_error_mean, angle_error_max : difference of corner angles, degrees, mean over corners by area;
        quasi_conformal_mean : area-weighted mean of the ratio of singular values, 1 for a conformal map.
    """
    scale = length_scale(mesh, image)
    errors = np.abs(corner_angles(image) - corner_angles(mesh))
    dilatation = quasi_conformal_dilatation(mesh, image)
    low, high = _weighted_percentiles(scale, mesh.areas, (1.0, 99.0))
    return {
        "length_scale_spread": float(high / max(low, 1e-300)),
        "length_scale_ratio": float(scale.max() / max(scale.min(), 1e-300)),
        "flipped_faces": float(flipped_faces(image, centre).sum()),
        "angle_error_mean": float(np.degrees(mesh.areas @ errors.mean(axis=1) / mesh.area)),
        "angle_error_max": float(np.degrees(errors.max())),
        "quasi_conformal_mean": float(mesh.areas @ dilatation / mesh.area),
    }


def length_scale(mesh: TriangleMesh, image: TriangleMesh) -> Floats:
    """(m,) sqrt(image area / area) of each face, the inverse of the conformal factor e^lambda of a conformal map."""
    return np.sqrt(image.areas / mesh.areas)


def corner_angles(mesh: TriangleMesh) -> Floats:
    """(m, 3) angles at the corners of the faces, in radians."""
    corners = mesh.vertices[mesh.faces]
    to_next, to_last = np.roll(corners, -1, axis=1) - corners, np.roll(corners, 1, axis=1) - corners
    sine = np.linalg.norm(np.cross(to_next, to_last), axis=2)
    return np.arctan2(sine, np.einsum("fcd,fcd->fc", to_next, to_last))


def flipped_faces(image: TriangleMesh, centre: Floats | None = None) -> np.ndarray:
    """(m,) bool, faces seen from the wrong side: below a plane domain, inside a sphere about `centre`."""
    outward = np.array([0.0, 0.0, 1.0]) if centre is None else image.vertices[image.faces].mean(axis=1) - centre
    return (image.face_cross_products * outward).sum(axis=1) <= 0


def quasi_conformal_dilatation(mesh: TriangleMesh, image: TriangleMesh) -> Floats:
    """(m,) ratio of the singular values of the linear map of each face, at least 1."""
    here, there = _side_products(mesh), _side_products(image)
    determinant = np.maximum(here[:, 0] * here[:, 2] - here[:, 1] ** 2, 1e-300)
    trace = (here[:, 2] * there[:, 0] - 2.0 * here[:, 1] * there[:, 1] + here[:, 0] * there[:, 2]) / determinant
    squeeze = np.maximum((there[:, 0] * there[:, 2] - there[:, 1] ** 2) / determinant, 1e-300)
    mean = np.maximum(trace / (2.0 * np.sqrt(squeeze)), 1.0)
    return mean + np.sqrt(mean**2 - 1.0)


def _side_products(mesh: TriangleMesh) -> Floats:
    """Entries E, F, G of the first fundamental form of each face in its own sides."""
    a, b, c = (mesh.vertices[mesh.faces[:, k]] for k in range(3))
    u, v = b - a, c - a
    return np.stack([(u * u).sum(axis=1), (u * v).sum(axis=1), (v * v).sum(axis=1)], axis=1)


def _weighted_percentiles(values: Floats, weights: Floats, percentages: tuple[float, ...]) -> Floats:
    order = np.argsort(values, kind="stable")
    cumulated = np.cumsum(weights[order])
    return values[order[np.searchsorted(cumulated, np.array(percentages) / 100.0 * cumulated[-1])]]
