"""What scikit-learn transformers of surfaces share: a list of surfaces in, and a name for the one that is unfit."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Callable, Iterable, Sequence
from pathlib import Path
from typing import Any, Self, TypeVar

import numpy as np
from sklearn.base import BaseEstimator, ClassNamePrefixFeaturesOutMixin, TransformerMixin
from sklearn.utils.validation import check_is_fitted

from surfexp.contract.arrays import Floats
from surfexp.mesh.given_numbers import whole_number
from surfexp.mesh.surface import Surface
from surfexp.tasks.given_surface import SurfaceLike

Surfaces = Sequence[SurfaceLike]
Made = TypeVar("Made")


class SurfaceTransformer(ClassNamePrefixFeaturesOutMixin, TransformerMixin, BaseEstimator):
    """What the transformers share: their input is a list of surfaces or paths, no array of numbers.

    Of scikit-learn's `check_estimator` those checks apply that give no data: parameters, cloning, tags.
    """

    n: int

    def __sklearn_tags__(self) -> Any:
        """Say that the input is no array of numbers."""
        tags = super().__sklearn_tags__()
        tags.input_tags.two_d_array = False
        tags.no_validation = True
        return tags

    def fit(self, X: Surfaces, y: Any = None) -> Self:
        """Check the number of modes, and keep what surfaces are compared with.

        Parameters
        ----------
        X : list of Surface, path, or (vertices, faces)
        y : optional
            Not used.

        Returns
        -------
        SurfaceTransformer
            Itself.

        Raises
        ------
        ValueError
            If the number of modes is no whole number from 1 on, or a surface that is kept is unfit or too coarse.
        """
        whole_number(self.n, "n", 1)
        self.n_features_out_ = self._learn(X)
        self.fitted_params_ = self.get_params()
        return self

    def transform(self, X: Surfaces) -> Floats:
        """Return a row of numbers for each surface: its signature, or its distances to those of `fit`.

        Parameters
        ----------
        X : list of Surface, path, or (vertices, faces)

        Returns
        -------
        (s, k) float64
            Of s surfaces.

        Raises
        ------
        ValueError
            If a surface is unfit or too coarse, or open where its volume is asked for; if a parameter is another than at `fit`.
        """
        check_is_fitted(self)
        for name, value in self.get_params().items():
            if value != (fitted := self.fitted_params_[name]):
                raise ValueError(
                    f"{name} = {value!r}, the transformer is fitted with {name} = {fitted!r}: fit it again"
                )
        rows = of_each(X, self._row)
        return np.reshape(rows, (len(rows), self.n_features_out_))

    @property
    def _n_features_out(self) -> int:
        """Under the name that scikit-learn numbers columns by."""
        return self.n_features_out_

    def _learn(self, X: Surfaces) -> int:
        """Keep what is compared with; return the length of a row."""
        return int(self.n)

    @abstractmethod
    def _row(self, given: SurfaceLike) -> Floats:
        """Return the (k,) row of one surface."""


def of_each(surfaces: Surfaces, make: Callable[[SurfaceLike], Made]) -> list[Made]:
    """Return what is made of each surface; what cannot be made says of which one."""
    if isinstance(surfaces, str | Path | Surface) or not isinstance(surfaces, Iterable):
        raise ValueError(f"X is a {type(surfaces).__name__}: give a list of surfaces")
    found = []
    for number, surface in enumerate(surfaces):
        try:
            found.append(make(surface))
        except ValueError as error:
            name = surface if isinstance(surface, str | Path) else getattr(surface, "name", "")
            raise ValueError(f"surface {number}{f' ({name})' if name else ''}: {error}") from None
    return found
