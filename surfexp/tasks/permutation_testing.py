"""A test at every vertex of a surface, corrected for all of them by rearranging the maps of subjects."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Literal, cast

import numpy as np
from numpy.typing import ArrayLike
from scipy.stats import t as student

from surfexp.contract.arrays import Floats
from surfexp.inference.designs import tested
from surfexp.inference.exchangeability import allowed_rearrangements, keeps_nuisance, least_p, way_to_smaller_p
from surfexp.inference.linear_model import contrast_model
from surfexp.inference.permutation_inference import Progress, Statistics, null_distributions
from surfexp.inference.vertex_graph import graph_of_edges
from surfexp.mesh.given_numbers import given_threads, real_number, whole_number
from surfexp.mesh.label_map import LabelMap
from surfexp.mesh.surface import Surface
from surfexp.tasks.given_labels import labels_on
from surfexp.tasks.given_map import MapLike, as_map, as_single_map
from surfexp.tasks.given_surface import SurfaceLike, as_surface
from surfexp.tasks.part_of_task import part_for
from surfexp.tasks.tested_clusters import tested_maps
from surfexp.tasks.tested_maps import PermutationTest

LARGEST_COUNT, LARGEST_SEED = 1_000_000, 2**128 - 1


def permutation_test(
    surface: SurfaceLike,
    maps: MapLike | Sequence[MapLike],
    design: ArrayLike | None = None,
    contrast: ArrayLike | None = None,
    *,
    groups: ArrayLike | None = None,
    pairs: ArrayLike | None = None,
    covariates: ArrayLike | None = None,
    blocks: ArrayLike | None = None,
    exchange: Literal["within", "whole"] = "within",
    rearrange: Literal["auto", "flip", "permute"] = "auto",
    count: int = 5000,
    forming_p: float = 0.001,
    extent_power: float = 1.0,
    height_power: float = 2.0,
    two_sided: bool = True,
    level: float = 0.05,
    labels: str | LabelMap | ArrayLike | None = None,
    seed: int = 0,
    threads: int | None = None,
    progress: Progress | None = None,
) -> PermutationTest:
    """Test maps of subjects at every vertex, with p-values that hold for all vertices at once.

    The statistic is t of a contrast in a linear model. Beside it stand the area and the mass of clusters, and the exact
    threshold-free cluster enhancement (TFCE): the integral over all thresholds, without a step. Signs are flipped where a mean
    is tested, which assumes errors that are symmetric about 0; else maps are permuted, which assumes that they can be
    exchanged (Freedman and Lane). All rearrangements that differ are taken where they are no more than `count`. p-values are
    then exact, unless the model has a covariate that they change beside the contrast. Both hemispheres are tested at once
    where they are one surface, as `read` gives it with left and right.

    Parameters
    ----------
    surface : Surface, path, or (vertices, faces)
        The test is made inside the mask, or where all maps are finite if there is no mask.
    maps : (n, s) float64, or list of str or (n,) float64
        The maps of s subjects on one surface.
    design : (s, p) array_like, optional
        Of a linear model; constants and covariates are columns. Without one the mean is tested. A slope needs a column of ones:
        np.column_stack([np.ones(s), age]) with the contrast [0, 1].
    contrast : (p,) array_like, optional
        Of the coefficients of the design; a design of one column needs none.
    groups : (s,) array_like, optional
        Two labels, instead of a design: the group that is named first less the other.
    pairs : (s,) array_like, optional
        With groups: which two maps belong together. Their difference is tested.
    covariates : (s,) or (s, q) array_like, optional
        Beside the mean or groups: what is regressed out. They are centred.
    blocks : (s,) array_like, optional
        Labels of observations that depend on one another, such as those of a family. Signs of a family flip together: a
        mean with blocks needs exchange="whole". Both maps of a pair are in one block.
    exchange : {"within", "whole"}
        Observations are permuted within their block; or blocks of equal size change places. Of any size they flip as wholes.
    rearrange : {"auto", "flip", "permute"}
        "auto" permutes where the model has a constant beside the contrast, and flips signs where a mean is tested.
    count : int
        Rearrangements, the unchanged one among them.
    forming_p : float
        Uncorrected p of Student's distribution from which on vertices form clusters.
    extent_power, height_power : float
        E and H of TFCE. 1 and 2 are those of FSL and PALM for surfaces, 0.5 and 2 those for volumes.
    two_sided : bool
        False tests for positive contrasts only.
    level : float
        Of the regions that are listed.
    labels : str, LabelMap, (n,) int or (n,) str, optional
        Parcels for the table of clusters, their file, or the name under which the surface carries them.
    seed : int
    threads : int, optional
        All cores if not given; the result is the same for any number.
    progress : callable, optional
        Receives the number of rearrangements done and the share that is left.

    Returns
    -------
    PermutationTest

    Raises
    ------
    ValueError
        If maps do not fit the surface or the design, the contrast cannot be estimated, or a number is out of range.

    References
    ----------
    Smith and Nichols: Threshold-free cluster enhancement (2009). Winkler, Ridgway, Webster, Smith, Nichols: Permutation
    inference for the general linear model (2014). Phipson and Smyth: Permutation p-values should never be zero (2010).

    Examples
    --------
    >>> import surfexp as sx
    >>> ball = sx.shape("icosphere", levels=3)
    >>> noise = np.random.default_rng(0).standard_normal((642, 12))
    >>> north = 3.0 * (ball.mesh.vertices[:, [2]] > 0.8)
    >>> found = sx.permutation_test(ball, noise + north, count=500)
    >>> inside = found.p_tfce[north[:, 0] > 0]
    >>> bool((inside < 0.05).mean() > 0.9), len(found.regions), found.facts["rearrangements"]
    (True, 1, '500 of 4,096 sign flips')
    """
    owner = as_surface(surface)
    columns = _columns(owner, maps)
    part = part_for(owner, columns)
    data = np.ascontiguousarray(np.asarray(part.restrict(columns), dtype=np.float64).T)
    given = len(data)
    data, asked = tested(data, design, contrast, groups, pairs, covariates, blocks)
    model = contrast_model(data, asked.matrix, asked.contrast)
    count = whole_number(count, "count", 2, LARGEST_COUNT)
    random = np.random.default_rng(whole_number(seed, "seed", 0, LARGEST_SEED))
    chosen, words = allowed_rearrangements(model, asked.matrix, asked.blocks, exchange, rearrange, count, random)
    forming = real_number(forming_p, "forming_p", above=0.0, below=0.5)
    statistics = Statistics(
        graph_of_edges(part.mesh.edges, part.mesh.vertex_areas * part.length**2),
        float(student.isf(forming / 2.0 if two_sided else forming, model.freedom)),
        real_number(extent_power, "extent_power", above=-1e-9),
        real_number(height_power, "height_power", above=-1e-9),
        bool(two_sided),
    )
    level = real_number(level, "level", above=0.0, below=1.0)
    parcels = _parcels(owner, labels)
    found = null_distributions(model, chosen, statistics, threads=given_threads(threads), progress=progress)
    advice = way_to_smaller_p(chosen, asked.blocks, exchange)
    facts = {
        "tested": asked.words,
        "maps": given,
        **({"differences": len(data)} if pairs is not None else {}),
        "degrees of freedom": model.freedom,
        "rearrangements": words,
        "all rearrangements": chosen.complete,
        "exact": chosen.complete and keeps_nuisance(model, chosen),
        "least p": least_p(model, chosen, bool(two_sided)),
        "threshold": statistics.threshold,
    }
    return tested_maps(owner, part, statistics, found, level, parcels, facts, advice)


def _columns(owner: Surface, maps: MapLike | Sequence[MapLike]) -> Floats:
    """The maps of subjects as columns."""
    if isinstance(maps, list | tuple):
        given = [as_single_map(owner, one) for one in maps]
        columns = np.column_stack(given) if given else np.empty((len(owner.mesh.vertices), 0))
    else:
        columns = as_map(owner, cast(MapLike, maps))
    if columns.ndim != 2 or columns.shape[1] < 2:
        raise ValueError(f"maps have shape {columns.shape}, (n, s) with at least 2 subjects is needed")
    return columns


def _parcels(owner: Surface, labels: str | LabelMap | ArrayLike | None) -> LabelMap | None:
    if labels is None:
        return None
    return labels_on(owner, labels)
