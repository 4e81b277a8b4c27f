"""Eigenvalues of polygonal drums to nine digits: cubic elements on graded meshes, extrapolated."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from surfexp.contract.arrays import Floats, Integers
from surfexp.mesh.shapes.isospectral_drum import Gluing, glued_drum, tile_mesh
from surfexp.operators.elements_surface import Boundary
from surfexp.spectrum.eigensolver import eigenpairs

from .drum_elements import drum_elements

ORDER = 3
# cubic elements: 6 is the order of their eigenvalues, then comes 8; 7 is what a doubt about the second term changes
POWERS, OTHER_POWERS = (6.0, 8.0), (6.0, 7.0)


@dataclass(frozen=True, eq=False)
class DrumValues:
    """Eigenvalues of a drum.

    Parameters
    ----------
    values : (k,) float64
        Extrapolated.
    estimates : (k,) float64
        Their relative errors, as the difference of two extrapolations.
    computed : (m, k) float64
        On each mesh; upper bounds where the rim is fixed.
    degrees_of_freedom : (m,) int64
    """

    values: Floats
    estimates: Floats
    computed: Floats
    degrees_of_freedom: Integers


def drum_values(
    gluing: Gluing,
    triangle: Floats,
    count: int = 25,
    divisions: tuple[int, ...] = (36, 48, 64),
    grading: float = 4.0,
    boundary: Boundary = "dirichlet",
) -> DrumValues:
    """Compute the first eigenvalues on a family of graded meshes, and extrapolate them to no mesh size.

    At a re-entrant corner of 3 pi / 2 eigenfunctions grow as the distance to the power 2/3, and elements of any order on even
    meshes give eigenvalues of order 4/3. Nodes drawn to the corners by the power q of the distance make that 4 q / 3;
    with q = 4 cubic elements are nearly of their full order 6, with errors a n^-6 + b n^-8 for n divisions, which three
    meshes eliminate.

    Parameters
    ----------
    gluing : three permutations
    triangle : (3, 2) float64
    count : int
    divisions : at least three even int, increasing
        Of a side of the tile: the graded parts of a side meet in its middle.
    grading : float

    Raises
    ------
    ValueError
        If the divisions are fewer than three, odd or not increasing.
    """
    if len(divisions) < len(POWERS) + 1 or any(n % 2 for n in divisions) or (np.diff(divisions) <= 0).any():
        raise ValueError(f"divisions are {tuple(divisions)}: at least 3 even numbers, increasing, are needed")
    computed, sizes = [], []
    for number in divisions:
        elements = drum_elements(glued_drum(gluing, triangle, *tile_mesh(number, grading)), ORDER, boundary)
        computed.append(eigenpairs(elements.stiffness, elements.mass, count, tolerance=1e-11).values)
        sizes.append(elements.stiffness.shape[0])
    table = np.stack(computed)
    values, other = (extrapolated(divisions, table, powers) for powers in (POWERS, OTHER_POWERS))
    # the constant mode of a free rim has no relative error
    estimates = np.abs(values - other) / np.maximum(np.abs(values), 1e-6 * values[-1])
    return DrumValues(values, estimates, table, np.array(sizes, dtype=np.int64))


def extrapolated(divisions: tuple[int, ...], computed: Floats, powers: tuple[float, ...]) -> Floats:
    """Return the limits of (m, k) values a + sum of b_p n^-p for n to infinity, by least squares over m meshes."""
    ratios = np.array(divisions, dtype=float) / divisions[0]
    design = np.stack([ratios**-power for power in (0.0, *powers)], axis=1)
    return np.asarray(np.linalg.lstsq(design, computed, rcond=None)[0][0])
