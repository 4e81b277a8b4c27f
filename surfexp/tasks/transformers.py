"""scikit-learn transformers: lists of surfaces in, rows of numbers out."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any, TypeVar

import numpy as np
from sklearn.base import BaseEstimator, TransformerMixin
from sklearn.utils.validation import check_is_fitted

from surfexp.anatomy.enclosed_volume import enclosed_volume
from surfexp.arrays import Floats
from surfexp.embedding.spectral_distance import spectral_distance
from surfexp.embedding.spectral_embedding import SpectralEmbedding, Weighting
from surfexp.mesh.surface import Surface
from surfexp.mesh.surface_part import SurfacePart
from surfexp.operators.fem import fem
from surfexp.spectrum.eigensystem import EigenSystem
from surfexp.spectrum.nodal_signature import Counting, counted_domains, zero_modes
from surfexp.spectrum.shape_dna import Normalisation, shape_dna
from surfexp.spectrum.surface_spectrum import graph_of, surface_spectrum
from surfexp.tasks.distances import embedded
from surfexp.tasks.inputs import SurfaceLike, as_surface, part_for

Surfaces = Sequence[SurfaceLike]
Made = TypeVar("Made")


class SurfaceTransformer(TransformerMixin, BaseEstimator):
    """What the transformers share: their input is a list of surfaces or paths, no array of numbers.

    Of scikit-learn's `check_estimator` those checks apply that give no data: parameters, cloning, tags.
    """

    def __sklearn_tags__(self) -> Any:
        """Say that the input is no array of numbers."""
        tags = super().__sklearn_tags__()
        tags.input_tags.two_d_array = False
        tags.no_validation = True
        return tags

    def fit(self, X: Surfaces, y: Any = None) -> SurfaceTransformer:
        """Check the number of modes; nothing is learned.

        Parameters
        ----------
        X : list of Surface, path, or (vertices, faces)
        y
            Not used.
        """
        self.n_features_out_ = _positive(self.n, "n")
        return self


class SignatureTransformer(SurfaceTransformer):
    """A transformer that makes one row of numbers of each surface by itself."""

    def transform(self, X: Surfaces) -> Floats:
        """Return the (s, n) signatures of s surfaces, a row each.

        Parameters
        ----------
        X : list of Surface, path, or (vertices, faces)

        Raises
        ------
        ValueError
            If a surface is unfit or too coarse, or open where its volume is asked for.
        """
        check_is_fitted(self)
        return np.stack(_of_each(X, self._row))

    @abstractmethod
    def _row(self, given: SurfaceLike) -> Floats:
        """Return the (n,) signature of one surface."""


class ShapeDNA(SignatureTransformer):
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
        part, system = _spectrum(given, self.n)
        volume = enclosed_volume(part.mesh) if not part.mesh.boundary_loops else None
        return shape_dna(system.values, self.normalisation, system.area, volume, self.reweighted)[: self.n]


class NodalCounts(SignatureTransformer):
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
        part, system = _spectrum(given, self.n)
        counts = counted_domains(system, graph_of(fem(part.mesh), system), self.counting)
        return counts[zero_modes(system) :][: self.n]


class SpectralDistance(SurfaceTransformer):
    """The spectral distances of surfaces to those that it was fitted to, each least over the signs of eigenfunctions.

    What `fit_transform` returns is symmetric with zeros on its diagonal: the input of whatever takes `metric="precomputed"`.

    Parameters
    ----------
    n : int
        Number of eigenfunctions.
    weighting : "biharmonic", "global_point", "heat_kernel" or "diffusion"
    limit : int
        Most evaluations of the search over signs.

    Examples
    --------
    >>> import surfexp as sx
    >>> bodies = [sx.shape("ellipsoid", levels=3), sx.shape("icosphere", levels=3)]
    >>> sx.SpectralDistance(n=3).fit_transform(bodies).diagonal().round(6)
    array([0., 0.])
    """

    def __init__(self, n: int = 20, weighting: Weighting = "biharmonic", limit: int = 2000) -> None:
        self.n = n
        self.weighting = weighting
        self.limit = limit

    def fit(self, X: Surfaces, y: Any = None) -> SpectralDistance:
        """Keep the embeddings of the surfaces to which distances are measured.

        Parameters
        ----------
        X : list of Surface, path, or (vertices, faces)
        y
            Not used.
        """
        _positive(self.n, "n")
        self.embeddings_ = _of_each(X, self._embedding)
        self.n_features_out_ = len(self.embeddings_)
        return self

    def transform(self, X: Surfaces) -> Floats:
        """Return the (s, r) distances of s surfaces to the r of `fit`.

        Parameters
        ----------
        X : list of Surface, path, or (vertices, faces)

        Raises
        ------
        ValueError
            If a surface is unfit or too coarse.
        """
        check_is_fitted(self)
        others = _of_each(X, self._embedding)
        return np.array(
            [[spectral_distance(one, other, limit=self.limit).value for other in self.embeddings_] for one in others]
        )

    def fit_transform(self, X: Surfaces, y: Any = None, **_: Any) -> Floats:
        """Return the (s, s) distances of s surfaces, each pair measured once.

        Parameters
        ----------
        X : list of Surface, path, or (vertices, faces)
        y
            Not used.
        """
        self.fit(X)
        matrix = np.zeros((len(self.embeddings_),) * 2)
        for i, one in enumerate(self.embeddings_):
            for j, other in enumerate(self.embeddings_[:i]):
                matrix[i, j] = matrix[j, i] = spectral_distance(one, other, limit=self.limit).value
        return matrix

    def _embedding(self, given: SurfaceLike) -> SpectralEmbedding:
        return embedded(given, self.n, self.weighting)[0]


def _of_each(surfaces: Surfaces, make: Callable[[SurfaceLike], Made]) -> list[Made]:
    """Return what is made of each surface; what cannot be made says of which one."""
    found = []
    for number, surface in enumerate(surfaces):
        try:
            found.append(make(surface))
        except ValueError as error:
            name = surface if isinstance(surface, str | Path) else getattr(surface, "name", "")
            raise ValueError(f"surface {number}{f' ({name})' if name else ''}: {error}") from None
    return found


def _spectrum(given: SurfaceLike, count: int) -> tuple[SurfacePart, EigenSystem]:
    """Return the part inside the mask and its first `count` pairs above 0, with the zero modes."""
    owner = as_surface(given)
    part = part_for(owner)
    cut = Surface(part.mesh, owner.name, owner.unit)
    return part, surface_spectrum(cut, fem(part.mesh), count + part.mesh.component_count)


def _positive(value: int, name: str) -> int:
    if not (isinstance(value, int | np.integer) and value >= 1):
        raise ValueError(f"{name} is {value!r}, must be an integer from 1 on")
    return int(value)
