"""Shape DNA and nodal counts as scikit-learn transformers: a row of numbers for each surface."""

from __future__ import annotations

from surfexp.anatomy.enclosed_volume import enclosed_volume
from surfexp.contract.arrays import Floats
from surfexp.mesh.surface import Surface
from surfexp.operators.surface_operator import SurfaceOperator
from surfexp.spectrum.eigensystem import EigenSystem
from surfexp.spectrum.lowest_pairs import lowest_pairs
from surfexp.spectrum.nodal_signature import Counting, counted_domains, zero_modes
from surfexp.spectrum.shape_dna import Normalisation, shape_dna
from surfexp.spectrum.surface_spectrum import graph_of
from surfexp.tasks.inputs import SurfaceLike, as_surface, part_for
from surfexp.tasks.surface_transformer import SurfaceTransformer


class ShapeDNA(SurfaceTransformer):
    """The first eigenvalues above 0 of each surface (Reuter, Wolter and Peinecke 2006).

    The defaults are those of the best retrieval on two collections, bodies in poses and structures of brains: mean average
    precision .904 with weights 1/i, the same to .001 from 20 to 100 values; .757 for 50 values and .715 for 100 without.

    Parameters
    ----------
    n : int
        How many.
    normalisation : "area", "raw", "volume", "first" or "slope"
        How size is taken out; "raw" leaves it in.
    reweighted : bool
        Divide the i-th value by i, so that all weigh about the same; false: as published.

    Examples
    --------
    >>> import surfexp as sx
    >>> sx.ShapeDNA(n=3, reweighted=False).fit_transform([sx.shape("icosphere", levels=3)]).round(0)
    array([[25., 25., 25.]])
    """

    def __init__(self, n: int = 35, normalisation: Normalisation = "area", reweighted: bool = True) -> None:
        self.n = n
        self.normalisation = normalisation
        self.reweighted = reweighted

    def _row(self, given: SurfaceLike) -> Floats:
        _, system = _spectrum(given, self.n)
        mesh = part_for(as_surface(given)).mesh
        volume = enclosed_volume(mesh) if mesh.is_closed else None
        return shape_dna(system.values, self.normalisation, system.area, volume, self.reweighted)[: self.n]


class NodalCounts(SurfaceTransformer):
    """The number of nodal domains of each of the first modes after the constant.

    Parameters
    ----------
    n : int
        How many modes.
    counting : "filtered", "raw", "soft" or "averaged"
        "filtered" leaves out domains that the mesh cannot resolve.

    Examples
    --------
    >>> import surfexp as sx
    >>> sx.NodalCounts(n=3).fit_transform([sx.shape("ellipsoid", levels=3)])
    array([[2., 2., 2.]])
    """

    def __init__(self, n: int = 50, counting: Counting = "filtered") -> None:
        self.n = n
        self.counting = counting

    def _row(self, given: SurfaceLike) -> Floats:
        operator, system = _spectrum(given, self.n)
        counts = counted_domains(system, graph_of(operator, system), self.counting)
        return counts[zero_modes(system) :][: self.n]


def _spectrum(given: SurfaceLike, count: int) -> tuple[SurfaceOperator, EigenSystem]:
    """Return the first `count` pairs above 0 of the part inside the mask, with the zero modes, and their operator."""
    owner = as_surface(given)
    part = part_for(owner)
    cut = Surface(part.mesh, owner.name, owner.unit)
    return lowest_pairs(cut, count + part.mesh.component_count)
