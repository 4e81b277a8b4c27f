"""What scikit-learn transformers of surfaces share: a list of surfaces in, and a name for the one that is unfit."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any, TypeVar

import numpy as np
from sklearn.base import BaseEstimator, TransformerMixin

from surfexp.tasks.inputs import SurfaceLike

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
        y : optional
            Not used.

        Returns
        -------
        SurfaceTransformer
            Itself.

        Raises
        ------
        ValueError
            If the number of modes is no integer from 1 on.
        """
        self.n_features_out_ = positive(self.n, "n")
        return self


def of_each(surfaces: Surfaces, make: Callable[[SurfaceLike], Made]) -> list[Made]:
    """Return what is made of each surface; what cannot be made says of which one."""
    found = []
    for number, surface in enumerate(surfaces):
        try:
            found.append(make(surface))
        except ValueError as error:
            name = surface if isinstance(surface, str | Path) else getattr(surface, "name", "")
            raise ValueError(f"surface {number}{f' ({name})' if name else ''}: {error}") from None
    return found


def positive(value: int, name: str) -> int:
    """Return a number of modes; ValueError if it is none."""
    if not (isinstance(value, int | np.integer) and value >= 1):
        raise ValueError(f"{name} is {value!r}, must be an integer from 1 on")
    return int(value)
