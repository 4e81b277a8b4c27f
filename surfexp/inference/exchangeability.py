"""Which rearrangements a model and the blocks of its observations allow."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from surfexp.contract.arrays import Floats, Integers
from surfexp.inference.designs import codes_of
from surfexp.inference.linear_model import ContrastModel
from surfexp.inference.rearrangements import Rearrangements, permutations, sign_flips
from surfexp.mesh.given_numbers import one_of

# rounding of two rearrangements whose statistic is the same
SAME = 1e-9


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
        "auto" permutes where the nuisance holds the constant, and flips elsewhere.
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
        If a word is unknown, blocks are missing, permutations cannot test the contrast, or flips would not heed the blocks.
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
        chosen = sign_flips(units, count, random)
        return chosen, _counted(chosen, f"{2 ** (int(units.max()) + 1):,}", "sign flips")
    if not model.has_mean:
        raise ValueError(
            "permuting cannot test a mean: choose rearrange = 'flip', or give the design a constant column"
        )
    strata: Integers = np.bincount(inside) if whole else inside
    chosen = permutations(units, strata, rows, count, random)
    return chosen, _counted(chosen, "", "permutations")


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
