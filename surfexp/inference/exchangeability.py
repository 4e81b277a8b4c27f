"""Which rearrangements a model and the blocks of its observations allow."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from surfexp.contract.arrays import Floats, Integers
from surfexp.inference.labels_of_maps import codes_of
from surfexp.inference.linear_model import INDEPENDENT, ContrastModel
from surfexp.inference.rearrangements import Rearrangements, permutations, sign_flips
from surfexp.mesh.given_numbers import one_of

# rounding of two rearrangements whose statistic is the same
SAME = 1e-9
# a million is 2^20
WRITTEN_OUT = 20


def allowed_rearrangements(
    model: ContrastModel,
    rows: Floats,
    blocks: ArrayLike | None,
    exchange: str,
    rearrange: str,
    count: int,
    random: np.random.Generator,
) -> tuple[Rearrangements, str]:
    """Return rearrangements, and what they are in words.

    Parameters
    ----------
    model : ContrastModel
    rows : (s, p) float64
        The design.
    blocks : (s,) array_like, optional
        Labels of observations that depend on one another.
    exchange : {"within", "whole"}
        Observations move within their block; or blocks of equal size change places. Of any size they flip as wholes.
    rearrange : {"auto", "flip", "permute"}
        "auto" permutes where the nuisance holds the constant, and flips where the design does.
    count : int
        The most.
    random : numpy.random.Generator

    Returns
    -------
    Rearrangements
    str

    Raises
    ------
    ValueError
        If a word is unknown, blocks are missing, permutations cannot test the contrast, flips would not heed the blocks, or
        "auto" finds no constant in the design.
    """
    size = len(model.direction)
    kind = one_of(rearrange, "rearrange", ("auto", "flip", "permute"))
    whole = one_of(exchange, "exchange", ("within", "whole")) == "whole"
    if whole and blocks is None:
        raise ValueError("exchange = 'whole' without blocks: give blocks")
    inside = np.zeros(size, dtype=np.int64) if blocks is None else codes_of(blocks, size, "blocks")[0]
    units = inside if whole else np.arange(size)
    if kind == "flip" or (kind == "auto" and not model.has_mean):
        if blocks is not None and not whole:
            raise ValueError(
                "blocks are given, but signs flip one by one, whatever the blocks: choose exchange = 'whole', which flips each "
                "block as a whole"
            )
        if kind == "auto" and not _holds_constant(model):
            raise ValueError(
                "the design has no constant: a slope is tested through 0, add a column of ones, whose contrast is 0, or choose "
                "rearrange = 'flip' if 0 is meant"
            )
        chosen = sign_flips(units, count, random)
        flipped = int(units.max()) + 1
        return chosen, _counted(chosen, f"{2**flipped:,}" if flipped < WRITTEN_OUT else f"2^{flipped}", "sign flips")
    if not model.has_mean:
        raise ValueError(
            "permuting cannot test a mean: choose rearrange = 'flip', or give the design a constant column"
        )
    strata: Integers = np.bincount(inside) if whole else inside
    chosen = permutations(units, strata, rows, count, random)
    return chosen, _counted(chosen, "", "permutations")


def _holds_constant(model: ContrastModel) -> bool:
    mean = np.full(len(model.direction), len(model.direction) ** -0.5)
    return bool(np.linalg.norm([model.direction @ mean, *(model.nuisance.T @ mean)]) > 1.0 - INDEPENDENT)


def _counted(chosen: Rearrangements, possible: str, kind: str) -> str:
    if chosen.complete:
        return f"all {len(chosen):,} {kind} that differ"
    return f"{len(chosen):,} of {possible} {kind}" if possible else f"{len(chosen):,} random {kind}"


def least_p(model: ContrastModel, chosen: Rearrangements, two_sided: bool) -> float:
    """Return the share of rearrangements whose statistic cannot differ from the observed one: no p-value is under it.

    Parameters
    ----------
    model : ContrastModel
    chosen : Rearrangements
    two_sided : bool

    Returns
    -------
    float
    """
    cosine = chosen.carried(model.direction) @ model.direction
    return float(((np.abs(cosine) if two_sided else cosine) > 1.0 - SAME).mean())


def keeps_nuisance(model: ContrastModel, chosen: Rearrangements) -> bool:
    """Return whether every rearrangement leaves the span of the nuisance as it is: p-values of all that differ are then exact.

    Residuals are rearranged in the place of data. Where the span stays, both have the same t; elsewhere p-values hold in the
    limit of many observations.

    Parameters
    ----------
    model : ContrastModel
    chosen : Rearrangements

    Returns
    -------
    bool
    """
    inside = ((chosen.carried(column) @ model.nuisance) ** 2 for column in model.nuisance.T)
    return all(bool((squares.sum(axis=1) > 1.0 - SAME).all()) for squares in inside)


def way_to_smaller_p(chosen: Rearrangements, blocks: ArrayLike | None, exchange: str) -> str:
    """Return what gives more rearrangements that differ, in words.

    Parameters
    ----------
    chosen : Rearrangements
    blocks : (s,) array_like, optional
    exchange : {"within", "whole"}

    Returns
    -------
    str
    """
    if not chosen.complete:
        return "raise count"
    if blocks is not None and exchange == "within":
        return "choose exchange = 'whole' if blocks can change places, else measure more subjects"
    return "measure more subjects"
