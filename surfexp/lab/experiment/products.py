"""Axes and figures that follow from lists of values: each combination is a member."""

from __future__ import annotations

import itertools
from collections.abc import Iterable, Mapping
from typing import Any

from surfexp.contract.member import FACTS
from surfexp.lab.errors import UserError, check_known
from surfexp.lab.experiment.configuration import assign, merge
from surfexp.lab.store.kinds import KINDS

Configuration = dict[str, Any]
AXIS = "the grid"
LONGEST = 100_000


def axes_written_out(configuration: Configuration) -> Configuration:
    """Return a configuration whose axes have members instead of products.

    Parameters
    ----------
    configuration : dict
        An axis may be {product: {OPTION: [VALUE, ...], ...}, class: OPTION, group: OPTION, level: OPTION}, or
        {product: grid}: the values of the experiment's own grid; or a list of such products. Stages beside a product hold
        for all its members. A fact that is no option is a word for all of them, and begins their labels.

    Raises
    ------
    UserError
        If a fact names an option that the product does not have, a level is no number, or two members have one label.

    Examples
    --------
    >>> axis = {"product": {"surface.level": [1, 2]}, "level": "surface.level"}
    >>> axes_written_out({"surface": {"name": "icosphere"}, "axes": {"spheres": axis}})["axes"]["spheres"]["level 2"]["level"]
    2.0
    """
    axes = configuration.get("axes") or {}
    if not any("product" in item for axis in axes.values() for item in _listed(axis) if isinstance(item, Mapping)):
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
        members = _combinations(axis, grid, {"class": lines, "level": [sweep["against"]]}, configuration)
        # one line where nothing but seeds is left; without a class each member would be a line of its own
        one = {} if lines else {"class": _word(str(sweep["sweep"]))}
        axes[axis] = {label: one | member for label, member in members.items()}
        label = _word(sweep["against"])
        drawn.append(
            {"name": "sweep", "metric": sweep["sweep"], "x_label": label, "inputs": {"solvers": {"over": axis}}} | words
        )
    kept = [item for item in figures if not any(item is sweep for sweep in sweeps)]
    once = {"grid": {option: values[:1] for option, values in grid.items()}, "figures": [*kept, *drawn]}
    return {**configuration, "axes": axes, "figures": kept, "variants": [{}, once]}


def _listed(axis: Any) -> list[Any]:
    return axis if isinstance(axis, list) else [axis]


def _members(name: str, axis: Any, configuration: Configuration) -> Any:
    items = _listed(axis)
    products = [item for item in items if isinstance(item, Mapping) and "product" in item]
    if not products:
        return axis
    if len(products) < len(items):
        raise UserError(f"axis {name}: products and members do not mix; give the members an axis of their own")
    members: dict[str, Configuration] = {}
    for item in products:
        for label, member in _product(name, item, configuration).items():
            if label in members:
                raise UserError(f"axis {name}: two members are {label!r}; tell their products apart: class: WORD")
            members[label] = member
    return members


def _product(name: str, axis: Mapping[str, Any], configuration: Configuration) -> dict[str, Configuration]:
    product = axis["product"] if axis["product"] != "grid" else configuration.get("grid") or {}
    if isinstance(product, Mapping):
        product = {option: _values(values) for option, values in product.items()}
    if not isinstance(product, Mapping) or not all(isinstance(values, list) for values in product.values()):
        raise UserError(
            f"axis {name}: product is {product!r}, options with lists of values are needed, or the word grid"
        )
    stages = {kind: axis[kind] for kind in KINDS if kind in axis}
    facts = {key: value for key, value in axis.items() if key != "product" and key not in stages}
    check_known(f"key of axis {name}", facts, FACTS)
    words = {fact: str(value) for fact, value in facts.items() if str(value).partition(".")[0] not in KINDS}
    chosen = {fact: [option] for fact, option in facts.items() if fact not in words}
    if "level" in words:
        words["level"] = _number(name, facts["level"])  # type: ignore[assignment]
    found = _combinations(name, product, chosen, merge(configuration, stages), {*stages})
    before = " ".join(str(word) for word in words.values())
    return {f"{before} {label}".strip(): words | member for label, member in found.items()}


def _values(given: Any) -> Any:
    """A list of values; {from: 0, to: 15} is that of the whole numbers, both ends included."""
    if not isinstance(given, Mapping) or set(given) != {"from", "to"}:
        return given
    first, last = given["from"], given["to"]
    if not all(isinstance(end, int) and not isinstance(end, bool) for end in (first, last)):
        return given
    if not 0 <= last - first < LONGEST:
        raise UserError(f"product: from {first} to {last} are {last - first + 1} values, 1 to {LONGEST} are possible")
    return list(range(first, last + 1))


def _combinations(
    name: str,
    product: Mapping[str, list[Any]],
    facts: Mapping[str, list[str]],
    configuration: Configuration,
    beside: Iterable[str] = (),
) -> dict[str, Configuration]:
    """The members of a product by label: their facts, and the stages whose options they set or that stand beside it."""
    for fact, options in facts.items():
        check_known(f"option of axis {name} by which {fact} goes", options, product)
    check_known(f"stage of axis {name}", [option.partition(".")[0] for option in product], KINDS)
    members: dict[str, Configuration] = {}
    for values in itertools.product(*product.values()):
        chosen = dict(zip(product, values, strict=True))
        kinds = dict.fromkeys([*beside, *(option.partition(".")[0] for option in product)])
        stages = {kind: configuration.get(kind) for kind in kinds}
        for option, value in chosen.items():
            stages = assign(stages, option, value)
        told = {fact: " ".join(_said(chosen[option]) for option in options) for fact, options in facts.items()}
        known: Configuration = {fact: words for fact, words in told.items() if words}
        if "level" in known:
            known["level"] = _number(name, chosen[facts["level"][0]])
        label = _label(chosen)
        if label in members:
            raise UserError(f"axis {name}: two members are {label!r}; leave one of two equal values out")
        members[label] = known | stages
    return members


def _number(axis: str, value: Any) -> float:
    if isinstance(value, bool) or not isinstance(value, int | float):
        raise UserError(f"axis {axis}: the level is {value!r}, a number is needed")
    return float(value)


def _label(chosen: Mapping[str, Any]) -> str:
    """A member's values, with the names of their options where no word is among them."""
    if any(isinstance(value, str | Mapping) for value in chosen.values()):
        return " ".join(map(_said, chosen.values()))
    return ", ".join(f"{_word(option)} {_said(value)}" for option, value in chosen.items())


def _said(value: Any) -> str:
    """A value as a label says it: a name in words."""
    word = str(value.get("name", value)) if isinstance(value, Mapping) else str(value)
    return word.replace("_", " ") if isinstance(value, str) else word


def _word(option: str) -> str:
    return option.rpartition(".")[2].replace("_", " ")
