"""Solids: tetrahedral meshes, their stiffness and mass, and their shape DNA."""

from __future__ import annotations

from functools import cached_property
from pathlib import Path
from typing import get_args

import numpy as np
from numpy.typing import ArrayLike
from scipy.sparse import csr_array

from surfexp.contract.arrays import Floats, Integers
from surfexp.extras import require_installed
from surfexp.mesh.given_arrays import frozen
from surfexp.mesh.given_numbers import one_of, whole_number
from surfexp.mesh.tetrahedra import boundary_vertices, signed_volumes, sound_tetrahedra
from surfexp.operators.elements_surface import Boundary
from surfexp.operators.solid_elements import solid_mass, solid_stiffness
from surfexp.spectrum.shape_dna import shape_dna
from surfexp.tasks.spectra import eigsh


class Solid:
    """A tetrahedral mesh with the matrices of linear elements, for `surfexp.eigsh`, and its shape DNA.

    Parameters
    ----------
    vertices : (n, 3) array
    tetrahedra : (m, 4) array
        In either orientation.

    Attributes
    ----------
    vertices : (n, 3) float64
    tetrahedra : (m, 4) int64
        Of positive volume: two corners of some are exchanged.
    notes : tuple of str
        What reading left out.

    Raises
    ------
    ValueError
        If the arrays are no mesh of tetrahedra of which at most two meet at a triangle.

    References
    ----------
    Reuter, Wolter, Peinecke: Laplace-Beltrami spectra as "Shape-DNA" of surfaces and solids (2006).

    Examples
    --------
    >>> import surfexp as sx
    >>> corners = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)])
    >>> cube = sx.Solid(corners, [[0, 1, 3, 7], [0, 1, 5, 7], [0, 2, 3, 7], [0, 2, 6, 7], [0, 4, 5, 7], [0, 4, 6, 7]])
    >>> round(cube.volume, 12), len(cube.boundary)
    (1.0, 8)
    >>> values, vectors = sx.eigsh(cube.stiffness, k=4, M=cube.mass, sigma=-0.1)
    >>> bool(abs(values[0]) < 1e-12), (values[1:] / np.pi**2).round(1).tolist()  # exact: 1, 1, 1
    (True, [1.2, 1.2, 1.2])
    """

    def __init__(self, vertices: ArrayLike, tetrahedra: ArrayLike) -> None:
        points, cells = sound_tetrahedra(vertices, tetrahedra)
        self.vertices: Floats = frozen(points, vertices)
        self.tetrahedra: Integers = frozen(cells, tetrahedra)
        self.notes: tuple[str, ...] = ()

    @classmethod
    def read(cls, path: Path | str) -> Solid:
        """Read a file of tetrahedra: VTK, gmsh, and whatever else meshio reads.

        Parameters
        ----------
        path : path

        Returns
        -------
        Solid
            Without vertices that belong to no tetrahedron; a note says so.

        Raises
        ------
        ValueError
            If the file cannot be read, or holds other cells with a volume.
        """
        require_installed("sx.Solid.read", "meshio")
        from surfexp.io.solid_files import read_tetrahedra

        vertices, tetrahedra, notes = read_tetrahedra(path)
        solid = cls(vertices, tetrahedra)
        solid.notes = notes
        return solid

    @cached_property
    def volume(self) -> float:
        """Sum of the volumes of the tetrahedra."""
        return float(signed_volumes(self.vertices, self.tetrahedra).sum())

    @cached_property
    def stiffness(self) -> csr_array:
        """(n, n) integrals of grad phi_i . grad phi_j."""
        return solid_stiffness(self.vertices, self.tetrahedra)

    @cached_property
    def mass(self) -> csr_array:
        """(n, n) integrals of phi_i phi_j."""
        return solid_mass(self.vertices, self.tetrahedra)

    @cached_property
    def boundary(self) -> Integers:
        """Vertices on the boundary, by increasing number."""
        return boundary_vertices(self.tetrahedra)

    def shape_dna(self, count: int = 50, *, boundary: Boundary = "neumann") -> Floats:
        """Return the lowest eigenvalues above 0 times volume^(2/3), which no change of size alters; proved complete.

        Parameters
        ----------
        count : int
        boundary : "neumann" or "dirichlet"

        Returns
        -------
        (count,) float64

        Raises
        ------
        ValueError
            If the mesh has too few vertices, or the proof fails.
        """
        count = whole_number(count, "count", 1)
        one_of(boundary, "boundary", get_args(Boundary))
        free = np.arange(len(self.vertices))
        if boundary == "dirichlet":
            free = np.setdiff1d(free, self.boundary)
        wanted = count + (self._pieces if boundary == "neumann" else 0)
        if wanted > len(free):
            raise ValueError(f"count = {count}: the {len(free)} free vertices have fewer values, take a finer mesh")
        a, b = (csr_array(matrix[free][:, free]) for matrix in (self.stiffness, self.mass))
        values = eigsh(a, k=wanted, M=b, sigma=0.0, return_eigenvectors=False)
        return shape_dna(np.asarray(values), "volume", volume=self.volume)[:count]

    @cached_property
    def _pieces(self) -> int:
        from scipy.sparse.csgraph import connected_components

        return int(connected_components(self.mass, directed=False)[0])
