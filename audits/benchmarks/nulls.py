"""A thousand nulls of one map on a cortex without its medial wall, by each null model, against the package that has it."""

from __future__ import annotations

from functools import partial
from importlib import import_module
from importlib.util import find_spec

import numpy as np
from scipy.sparse import csc_matrix, csr_array

import surfexp as sx
from audits.benchmarks.line import Line, not_installed, race
from audits.benchmarks.measurement import measure_both
from surfexp.anatomy.fsaverage5 import fsaverage5
from surfexp.contract.arrays import Floats, Integers
from surfexp.mesh.masked_surface import cut_to_mask
from surfexp.mesh.shapes.icosphere import icosphere
from surfexp.mesh.surface import Surface
from surfexp.nulls.eigenstrapping import eigenstrapped
from surfexp.nulls.fields import gaussian_fields
from surfexp.nulls.kept import power_error, variogram_error
from surfexp.nulls.neighbourhoods import nearest_along_surface
from surfexp.nulls.spins import random_rotations, spin_sources, spun
from surfexp.nulls.variogram import VariogramPairs, variogram_pairs
from surfexp.nulls.variogram_matching import VariogramMatching
from surfexp.operators.assembly import mass_matrix
from surfexp.operators.fem import fem

COUNT, QUICK = 1000, 40
# of kernels: the package takes null by null, each as long as the one before
BY_VARIOGRAM = 100
MODES, NEIGHBOURS, FRACTIONS = 400, 1000, (0.3, 0.5, 0.7, 0.9)
WIDTH, REACH = 20.0, 50.0
# no less than the packages; ten times where they take null by null what is one product of matrices
EIGENSTRAPPING, VARIOGRAM, SPINS = 1.0, 10.0, 1.0


def warm_up() -> None:
    """Compile what the lines use."""
    ball = icosphere(3)
    sx.eigenpairs(ball, 20)
    nearest_along_surface(ball.mesh, 20)


def lines(quick: bool) -> list[Line]:
    """Return a line for each null model."""
    count = QUICK if quick else COUNT
    whole = fsaverage5("left", "white")
    surface = cut_to_mask(whole, whole.scalars["thickness"] > 0)
    values = gaussian_fields(fem(surface.mesh), WIDTH, 1, 19)[:, 0]
    return [
        _eigenstrapping(surface, values, count),
        _variogram(surface, values, min(count, BY_VARIOGRAM)),
        _spins(count),
    ]


def _eigenstrapping(surface: Surface, values: Floats, count: int) -> Line:
    work, rival = (
        f"{count} eigenstrapping nulls of a map, {MODES} modes, masked fsaverage5",
        "neuromodes, rotations by QR",
    )
    if find_spec("neuromodes") is None:
        return not_installed(work, rival, EIGENSTRAPPING, "neuromodes")
    system, mass = sx.eigenpairs(surface, MODES, tolerance=1e-10), mass_matrix(fem(surface.mesh))
    (nulls, cost), (theirs, their_cost) = measure_both(
        partial(eigenstrapped, system.vectors, mass, values, count),
        partial(neuromodes, system.vectors, system.values, mass, values, count),
    )
    within = system.vectors @ (system.vectors.T @ (mass @ values))
    errors = [power_error(system.vectors, mass, within, maps).max() for maps in (nulls, theirs)]
    accuracy = f"largest error of the power by group: ours {errors[0]:.0e}, theirs {errors[1]:.0e}"
    return race(work, rival, EIGENSTRAPPING, cost, their_cost, accuracy, fair=errors[0] <= 1e-10)


def neuromodes(modes: Floats, eigenvalues: Floats, mass: csr_array, values: Floats, count: int) -> Floats:
    """Its documented call, without the checks that cost."""
    eigenstrap = import_module("neuromodes.nulls").eigenstrap
    return np.asarray(
        eigenstrap(values, modes, eigenvalues, n_nulls=count, mass=csc_matrix(mass), seed=0, checks=False)
    )


def _variogram(surface: Surface, values: Floats, count: int) -> Line:
    work = (
        f"{count} variogram-matched nulls of a map, kernels of .3 to .9 of {NEIGHBOURS} neighbours, masked fsaverage5"
    )
    rival = "brainsmash, Sampled with its defaults"
    if find_spec("brainsmash") is None:
        return not_installed(work, rival, VARIOGRAM, "brainsmash")
    neighbours, distances = nearest_along_surface(surface.mesh, NEIGHBOURS)
    pairs = variogram_pairs(surface.mesh, reach=REACH)
    (nulls, cost), (theirs, their_cost) = measure_both(
        partial(ours_by_variogram, neighbours, distances, pairs, values, count),
        partial(brainsmash, neighbours, distances, values, count),
    )
    errors = [float(np.median(variogram_error(pairs, values, maps))) for maps in (nulls, theirs)]
    accuracy = f"median error of the variogram over its mean: ours {errors[0]:.2f}, theirs {errors[1]:.2f}"
    return race(work, rival, VARIOGRAM, cost, their_cost, accuracy, fair=errors[0] <= 1.1 * errors[1])


def ours_by_variogram(
    neighbours: Integers, distances: Floats, pairs: VariogramPairs, values: Floats, count: int
) -> Floats:
    """With the kernels that have to be made for it."""
    return VariogramMatching(neighbours, distances, pairs, FRACTIONS).nulls(values, count)


def brainsmash(neighbours: Integers, distances: Floats, values: Floats, count: int) -> Floats:
    """Its documented call, on the same neighbours and by as many vertices as it ships with."""
    made = import_module("brainsmash.mapgen.sampled").Sampled(
        values, distances, neighbours, knn=neighbours.shape[1], seed=0
    )(n=count)
    return np.asarray(made).reshape(count, -1).T


def _spins(count: int) -> Line:
    work, rival = f"{count} spins of a map on the sphere of fsaverage5", "brainspace, SpinPermutations"
    if find_spec("brainspace") is None:
        return not_installed(work, rival, SPINS, "brainspace")
    whole = fsaverage5("left", "sphere")
    values, sphere = whole.scalars["sulc"], whole.mesh.vertices
    (nulls, cost), (theirs, their_cost) = measure_both(
        partial(ours_by_spins, sphere, values, count), partial(brainspace, sphere, values, count)
    )
    # share of the values of the map that stand in a null
    shares = [np.mean([len(np.unique(null)) for null in maps.T]) / len(np.unique(values)) for maps in (nulls, theirs)]
    accuracy = f"share of the map's values in a null: ours {shares[0]:.3f}, theirs {shares[1]:.3f}"
    return race(work, rival, SPINS, cost, their_cost, accuracy, fair=bool(abs(shares[0] - shares[1]) < 0.01))


def ours_by_spins(sphere: Floats, values: Floats, count: int) -> Floats:
    """Rotations, nearest vertices, values."""
    return spun(values, spin_sources(sphere, random_rotations(count)))


def brainspace(sphere: Floats, values: Floats, count: int) -> Floats:
    """Its documented calls."""
    spins = import_module("brainspace.null_models").SpinPermutations(n_rep=count, random_state=0).fit(sphere)
    return np.asarray(spins.randomize(values)).reshape(count, -1).T
