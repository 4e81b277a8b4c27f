"""Synthetic subjects: smooth random deformations of one template, with a stretch of one region planted on one side."""

from __future__ import annotations

from dataclasses import replace
from typing import Literal

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from surfexp.contract.arrays import Floats
from surfexp.mesh.shape_metrics import with_metrics
from surfexp.mesh.surface import Surface
from surfexp.mesh.triangle_mesh import TriangleMesh
from surfexp.populations.disguise import disguise

Side = Literal["left", "right"]
SIDES: tuple[Side, ...] = ("left", "right")
WAVES = 24
REACH = 8.0


def random_displacement(points: Floats, strain: float, wavelength: float, seed: int) -> Floats:
    """Return a smooth random vector field at points, whose derivatives have the root mean square `strain`.

    Parameters
    ----------
    points : (n, 3) float64
    strain : float
        0.02 changes lengths by about 2 % here and there.
    wavelength : float
        Of its waves, in the unit of the points.
    seed : int
    """
    if strain < 0 or not wavelength > 0:
        raise ValueError(f"strain {strain:g}, wavelength {wavelength:g}: take at least 0 and a positive one")
    rng = np.random.default_rng(seed)
    directions = rng.normal(size=(WAVES, 3))
    waves = 2.0 * np.pi / wavelength * directions / np.linalg.norm(directions, axis=1, keepdims=True)
    phases = rng.uniform(0.0, 2.0 * np.pi, WAVES)
    moves = rng.normal(size=(WAVES, 3))
    # a wave of amplitude a has a mean square derivative (a 2 pi / wavelength)^2 / 2 along its own direction
    moves *= strain * wavelength / (2.0 * np.pi) * np.sqrt(2.0 / WAVES)
    return np.asarray(np.sin(points @ waves.T + phases) @ moves)


def stretch(
    points: Floats, region: NDArray[np.bool_], share: float, direction: Floats | None = None, reach: float = REACH
) -> Floats:
    """Return points with those of a region lengthened by `share` along one direction, fading outside over `reach`.

    Parameters
    ----------
    points : (n, 3) float64
    region : (n,) bool
        Not empty.
    share : float
        0.06 makes it 6 % longer.
    direction : (3,) float64, optional
        Default: the main direction of the region.
    reach : float
        In the unit of the points.
    """
    members = points[region]
    if len(members) < 3:
        raise ValueError(f"the region to be stretched has {len(members)} vertices, at least 3 are needed")
    centre = members.mean(axis=0)
    if direction is None:
        direction = np.linalg.svd(members - centre, full_matrices=False)[2][0]
    direction = np.asarray(direction / np.linalg.norm(direction))
    weight = np.exp(-((cKDTree(members).query(points)[0] / reach) ** 2))
    along = (points - centre) @ direction
    return np.asarray(points + (share * weight * along)[:, None] * direction)


def synthetic_subject(
    template: Surface,
    subject: int,
    side: Side,
    strain: float = 0.03,
    wavelength: float = 60.0,
    region: NDArray[np.bool_] | None = None,
    asymmetry: float = 0.0,
    direction: Floats | None = None,
    remeshed: bool = True,
    seed: int = 0,
) -> Surface:
    """One hemisphere of a synthetic subject; the right one is the mirrored template, so that nothing but chance differs.

    Half of the strain's square is common to both sides of a subject, half is of each side.

    Parameters
    ----------
    template : Surface
        A left hemisphere.
    subject : int
        From 0.
    side : "left" or "right"
    strain, wavelength
        As in `random_displacement`.
    region : (n,) bool, optional
        What is longer by `asymmetry` on the left; half the share is added there and half taken off on the right.
    direction : (3,) float64, optional
        In which it is longer, see `stretch`.
    remeshed : bool
        New vertices; always in a random order.
    seed : int
        Of the population.

    Returns
    -------
    Surface
        With the maps of the template, and as its true origin the template's vertices.
    """
    if side not in ("left", "right"):
        raise ValueError(f"side {side!r} is unknown, choose left or right")
    vertices = np.array(template.mesh.vertices)
    number = 1000003 * seed + 10 * subject
    moved = vertices + random_displacement(vertices, strain / np.sqrt(2.0), wavelength, number)
    own = number + (1 if side == "left" else 2)
    moved += random_displacement(vertices, strain / np.sqrt(2.0), wavelength, own)
    if region is not None and asymmetry != 0.0:
        moved = stretch(moved, region, 0.5 * asymmetry * (1.0 if side == "left" else -1.0), direction)
    changed = replace(template.deformed(TriangleMesh(moved, template.mesh.faces)), metrics={})
    result = disguise(changed, rotated=True, remeshed=remeshed, seed=own)
    if side == "right":
        # mirrored last, since meshing anew depends on the orientation and would set the sides apart
        mirrored = TriangleMesh(result.mesh.vertices * [-1.0, 1.0, 1.0], result.mesh.faces[:, ::-1])
        result = replace(result, mesh=mirrored, metrics={})
    truth = replace(result.truth, template=template.mesh.identity)
    return with_metrics(replace(result, name=f"synthetic subject {subject}, {side}", truth=truth))
