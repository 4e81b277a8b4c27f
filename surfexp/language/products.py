"""Axes and figures that follow from lists of values: each combination is a member."""

from __future__ import annotations

import itertools
from collections.abc import Mapping
from typing import Any

from surfexp.member import FACTS
from surfexp.workflow.configuration import assign
from surfexp.workflow.errors import UserError, check_known
from surfexp.workflow.kinds import KINDS

Configuration = dict[str, Any]
AXIS = "the grid"


def axes_written_out(configuration: Configuration) -> Configuration:
    """Return a configuration whose axes have members instead of products.

    Parameters
    ----------
    configuration : dict
        An axis may be {product: {OPTION: [VALUE, ...], ...}, class: OPTION, group: OPTION, level: OPTION}, or
        {product: grid}: the values of the experiment's own grid.

    Raises
    ------
    UserError
        If a fact names an option that the product does not have, or a level is no number.

    Examples
    --------
    >>> axis = {"product": {"surface.level": [1, 2]}, "level": "surface.level"}
    >>> axes_written_out({"surface": {"name": "icosphere"}, "axes": {"spheres": axis}})["axes"]["spheres"]["2"]["level"]
    2.0
    """
    axes = configuration.get("axes") or {}
    if not any(isinstance(axis, Mapping) and "product" in axis for axis in axes.values()):
        return configuration
    written = {name: _members(name, axis, configuration) for name, axis in axes.items()}
    return {**configuration, "axes": written}


def with_sweeps(configuration: Configuration) -> Configuration:
    """Return a configuration in which a figure {sweep: METRIC, against: OPTION} is a figure over the whole grid, once.

    Raises
    ------
    UserError
        If the grid has no such option, or the experiment has variants, whose grids differ.
    """
    figures = configuration.get("figures") or []
    sweeps = [item for item in figures if isinstance(item, Mapping) and "against" in item]
    if not sweeps:
        return configuration
    grid = configuration.get("grid") or {}
    if configuration.get("variants"):
        raise UserError("figures: a sweep against an option is over one grid, but there are variants; give it an axis")
    axes, drawn = dict(configuration.get("axes") or {}), []
    for sweep in sweeps:
        check_known("option of the grid that a sweep goes against", [sweep["against"]], grid)
        if "sweep" not in sweep:
            raise UserError(f"figures: what is drawn against {sweep['against']}? sweep: METRIC is missing")
        words = {key: value for key, value in sweep.items() if key not in ("sweep", "against")}
        axis = f"{AXIS}, against {sweep['against']}"
        lines = [option for option in grid if option != sweep["against"] and not option.endswith(".seed")]
        axes[axis] = _combinations(axis, grid, {"class": lines, "level": [sweep["against"]]}, configuration)
        label = _word(sweep["against"])
        drawn.append(
            {"name": "sweep", "metric": sweep["sweep"], "x_label": label, "inputs": {"solvers": {"over": axis}}} | words
        )
    kept = [item for item in figures if not any(item is sweep for sweep in sweeps)]
    once = {"grid": {option: values[:1] for option, values in grid.items()}, "figures": [*kept, *drawn]}
    return {**configuration, "axes": axes, "figures": kept, "variants": [{}, once]}


def _members(name: str, axis: Any, configuration: Configuration) -> Any:
    if not isinstance(axis, Mapping) or "product" not in axis:
        return axis
    product = axis["product"] if axis["product"] != "grid" else configuration.get("grid") or {}
    if not isinstance(product, Mapping) or not all(isinstance(values, list) for values in product.values()):
        raise UserError(
            f"axis {name}: product is {product!r}, options with lists of values are needed, or the word grid"
        )
    facts = {fact: option for fact, option in axis.items() if fact != "product"}
    check_known(f"key of axis {name}", facts, FACTS)
    return _combinations(name, product, {fact: [option] for fact, option in facts.items()}, configuration)


def _combinations(
    name: str, product: Mapping[str, list[Any]], facts: Mapping[str, list[str]], configuration: Configuration
) -> dict[str, Configuration]:
    """The members of a product by label: their facts, and the stages whose options they set."""
    for fact, options in facts.items():
        check_known(f"option of axis {name} by which {fact} goes", options, product)
    check_known(f"stage of axis {name}", [option.partition(".")[0] for option in product], KINDS)
    members = {}
    for values in itertools.product(*product.values()):
        chosen = dict(zip(product, values, strict=True))
        stages = {option.partition(".")[0]: configuration.get(option.partition(".")[0]) for option in product}
        for option, value in chosen.items():
            stages = assign(stages, option, value)
        told = {fact: " ".join(_said(chosen[option]) for option in options) for fact, options in facts.items()}
        known: Configuration = {fact: words for fact, words in told.items() if words}
        if "level" in known:
            known["level"] = _number(name, chosen[facts["level"][0]])
        members[" ".join(map(_said, values))] = known | stages
    return members


def _number(axis: str, value: Any) -> float:
    if isinstance(value, bool) or not isinstance(value, int | float):
        raise UserError(f"axis {axis}: the level is {value!r}, a number is needed")
    return float(value)


def _said(value: Any) -> str:
    return str(value.get("name", value)) if isinstance(value, Mapping) else str(value)


def _word(option: str) -> str:
    return option.rpartition(".")[2].replace("_", " ")
