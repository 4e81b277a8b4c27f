"""Claims in their short form: the statement above the quantity, the interval below it."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import yaml

from surfexp.lab.errors import UserError, check_known

QUANTITIES = ("all", "any", "mean", "min", "max", "ratio")
BELOW = ("between", "because", "not_comparable", "published", "reference", "unconverged", "moved", "otherwise", "cause")
PARTS = {"metric": "metric", "of": "rows", "to": "over"}
UNEXPLAINED = "No reason is given."


def claims_of(file: Path) -> list[Any]:
    """Return the claims of an experiment's file, each written out."""
    claims = yaml.safe_load(file.read_text(encoding="utf-8")).get("claims") or []
    return [claim_written_out(claim, number) for number, claim in enumerate(claims, 1)]


def claim_written_out(given: Any, number: int) -> Any:
    """Return a claim as `surfexp.lab.experiment.claim` reads it; one that is written so already as it is.

    Parameters
    ----------
    given : object
        {STATEMENT: {QUANTITY: {metric: ..., of: ..., to: ...}, between: [low, high], ...}}, or
        {claim: STATEMENT, QUANTITY: {...}, between: [low, high], ...}.
    number : int
        The claim's place in the list, from 1.

    Raises
    ------
    UserError
        If it has no quantity or several, or the quantity says what it has no part for.

    Examples
    --------
    >>> claim_written_out({"It is small": {"all": {"metric": "rmse"}, "between": [0, 3]}}, 1)["quantity"]
    'all'
    """
    if not isinstance(given, Mapping) or "quantity" in given or ("claim" not in given and len(given) != 1):
        return given
    if "claim" in given:  # a statement that is too long for a key
        statement, body = given["claim"], {key: value for key, value in given.items() if key != "claim"}
    else:
        ((statement, body),) = given.items()
    where = f"claim {number} ({str(statement)[:60]})"
    if not isinstance(body, Mapping):
        raise UserError(f"{where}: a quantity and an interval are needed below the statement, it has {body!r}")
    check_known(f"key in {where}", body, [*QUANTITIES, *BELOW])
    quantities = [name for name in QUANTITIES if name in body]
    if len(quantities) != 1:
        found = " and ".join(quantities) or "no quantity"
        raise UserError(f"{where}: {found} given, one of {', '.join(QUANTITIES)} is needed")
    (quantity,) = quantities
    inner = body[quantity] if isinstance(body[quantity], Mapping) else {"metric": body[quantity]}
    check_known(f"part of {quantity} in {where}", inner, PARTS)
    rest = {key: value for key, value in body.items() if key != quantity}
    foreign = "published" in rest or "reference" in rest
    why = {} if foreign else {"because": UNEXPLAINED}
    return {
        "claim": statement,
        "quantity": quantity,
        **{PARTS[key]: value for key, value in inner.items()},
        **why,
        **rest,
    }
