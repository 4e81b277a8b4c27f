"""The null models that the study compares, each as a function of a map and a seed."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np

from surfexp.contract.arrays import Floats
from surfexp.mesh.surface import Surface
from surfexp.nulls.eigenstrapping import eigenstrapped
from surfexp.nulls.neighbourhoods import nearest_along_surface
from surfexp.nulls.spins import random_rotations, spin_sources, spun
from surfexp.nulls.values_of_map import permuted_values
from surfexp.nulls.variogram import VariogramPairs
from surfexp.nulls.variogram_matching import FRACTIONS, VariogramMatching
from surfexp.operators.assembly import mass_matrix
from surfexp.operators.surface_operator import SurfaceOperator
from surfexp.spectrum.eigensystem import EigenSystem

NullModel = Callable[[Floats, int, int], Floats]
# a tenth of the vertices of the narrowest published kernel, and on by factors of about two
FINE_FRACTIONS = (0.01, 0.02, 0.05, 0.1, 0.2, 0.4, 0.8)
# share of the modes that the row of few modes has
FEW = 4
METHODS = (
    "eigenstrapping",
    "eigenstrapping_rest",
    "eigenstrapping_few",
    "spins",
    "variogram",
    "variogram_fine",
    "permutation",
)


@dataclass(frozen=True, eq=False)
class OneSurface:
    """A surface with what null models need of it.

    Parameters
    ----------
    surface : Surface
        Cut to its mask.
    sphere : Surface
        The whole hemisphere as a sphere about the origin.
    operator : SurfaceOperator
    eigensystem : EigenSystem
    pairs : VariogramPairs
    neighbours : int
        How many nearest vertices the widest kernel of the variogram's nulls has, or all where there are fewer.
    """

    surface: Surface
    sphere: Surface
    operator: SurfaceOperator
    eigensystem: EigenSystem
    pairs: VariogramPairs
    neighbours: int = 1000


def null_models(of: OneSurface) -> Mapping[str, NullModel]:
    """Return functions of a map (n,), a number of nulls r and a seed that give nulls (n, r).

    Parameters
    ----------
    of : OneSurface

    Returns
    -------
    mapping of str to function
        METHODS, in their order.

    Raises
    ------
    ValueError
        If the sphere has not the vertices from which the surface was cut.
    """
    n, modes, mass = len(of.surface.mesh.vertices), of.eigensystem.vectors, mass_matrix(of.operator)
    few = np.asfortranarray(modes[:, : max(modes.shape[1] // FEW, 1)])
    part = None if of.surface.part is None else of.surface.part.vertices
    whole = n if of.surface.part is None else of.surface.part.whole_count
    directions = of.sphere.mesh.vertices
    if len(directions) != whole:
        raise ValueError(
            f"sphere has {len(directions)} vertices, the surface was cut from {whole}: they must be the same"
        )
    nearest = nearest_along_surface(of.surface.mesh, min(of.neighbours, n))
    published = VariogramMatching(*nearest, of.pairs, FRACTIONS)
    fine = VariogramMatching(*nearest, of.pairs, FINE_FRACTIONS)
    models: tuple[NullModel, ...] = (
        lambda values, count, seed: eigenstrapped(modes, mass, values, count, seed=seed),
        lambda values, count, seed: eigenstrapped(modes, mass, values, count, rest="permute", seed=seed),
        lambda values, count, seed: eigenstrapped(few, mass, values, count, seed=seed),
        lambda values, count, seed: spun(values, spin_sources(directions, random_rotations(count, seed), part)),
        lambda values, count, seed: published.nulls(values, count, seed=seed),
        lambda values, count, seed: fine.nulls(values, count, seed=seed),
        lambda values, count, seed: permuted_values(values, count, np.random.default_rng(seed)),
    )
    return dict(zip(METHODS, models, strict=True))
