"""Datasets and figures that follow from lists of values: each combination is an item."""

from __future__ import annotations

import itertools
from collections.abc import Iterable, Mapping
from typing import Any

from surfexp.contract.member import FACTS
from surfexp.lab.errors import UserError, check_known
from surfexp.lab.experiment.configuration import assign, merge
from surfexp.lab.store.kinds import KINDS

Configuration = dict[str, Any]
Item = dict[str, Any]
OF_THE_GRID = "the grid"


def seeds(repeat: Mapping[str, Any]) -> dict[str, list[int]]:
    """Return the values of seeds that are repeated, 0, 1, 2, ..., by option.

    Raises
    ------
    UserError
        If an option is no seed, or its number of repetitions is none from 1 to 10,000.
    """
    for option, count in repeat.items():
        if not isinstance(count, int) or isinstance(count, bool) or not 1 <= count <= 10_000:
            raise UserError(f"repeat: {str(option)!r} is {count!r}, a number of repetitions from 1 to 10000 is needed")
        if str(option).rpartition(".")[2] != "seed":
            raise UserError(f"repeat: {option!r} is no seed; values of other options stand in the grid")
    return {str(option): list(range(count)) for option, count in repeat.items()}


def datasets_written_out(configuration: Configuration) -> Configuration:
    """Return a configuration whose datasets have one entry for each item.

    Parameters
    ----------
    configuration : dict
        An item with a `grid` of options, or a `repeat` of seeds, stands for one item for each combination. Stages beside
        the grid hold for all of them. A fact (class, group, level) that names an option of the grid takes that option's
        value; one that does not is a word for all of them, and begins their labels.

    Raises
    ------
    UserError
        If a fact names an option that the grid does not have, or a level is no number.

    Examples
    --------
    >>> items = [{"grid": {"surface.level": [1, 2]}, "level": "surface.level"}]
    >>> found = datasets_written_out({"surface": {"name": "icosphere"}, "datasets": {"spheres": items}})
    >>> [(item["label"], item["level"]) for item in found["datasets"]["spheres"]]
    [('level 1', 1.0), ('level 2', 2.0)]
    """
    datasets = configuration.get("datasets") or {}
    if not any(stands_for_many(item) for items in datasets.values() for item in items):
        return configuration
    return {
        **configuration,
        "datasets": {name: _items(name, items, configuration) for name, items in datasets.items()},
    }


def stands_for_many(item: Any) -> bool:
    """Whether an item has a grid or seeds."""
    return isinstance(item, Mapping) and bool(item.keys() & {"grid", "repeat"})


def with_sweeps(configuration: Configuration) -> Configuration:
    """Return a configuration in which a figure {name: sweep, metric: ..., against: OPTION} is drawn over the grid, once.

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
        raise UserError(
            "figures: a sweep against an option is over one grid, but there are variants; give it a dataset"
        )
    datasets, drawn = dict(configuration.get("datasets") or {}), []
    for sweep in sweeps:
        check_known("option of the grid that a sweep goes against", [sweep["against"]], grid)
        if "metric" not in sweep:
            raise UserError(f"figures: what is drawn against {sweep['against']}? metric: METRIC is missing")
        name = f"{OF_THE_GRID}, against {sweep['against']}"
        lines = [option for option in grid if option != sweep["against"] and not option.endswith(".seed")]
        items = _combinations(name, grid, {"class": lines, "level": [sweep["against"]]}, configuration)
        # one line where nothing but seeds is left; without a class each item would be a line of its own
        one = {} if lines else {"class": _word(str(sweep["metric"]))}
        datasets[name] = [one | item for item in items]
        words = {key: value for key, value in sweep.items() if key != "against"}
        drawn.append({"x_label": _word(sweep["against"]), "inputs": {"solvers": {"dataset": name}}} | words)
    kept = [item for item in figures if not any(item is sweep for sweep in sweeps)]
    once = {"grid": {option: values[:1] for option, values in grid.items()}, "figures": [*kept, *drawn]}
    return {**configuration, "datasets": datasets, "figures": kept, "variants": [{}, once]}


def _items(name: str, items: list[Any], configuration: Configuration) -> list[Item]:
    found: list[Item] = []
    for number, item in enumerate(items):
        if stands_for_many(item):
            found += _of_a_grid(name, item, configuration)
        else:
            found.append({"label": str(number), **item})
    return found


def _of_a_grid(name: str, item: Mapping[str, Any], configuration: Configuration) -> list[Item]:
    grid = item.get("grid") or {}
    if not isinstance(grid, Mapping) or not all(isinstance(values, list) for values in grid.values()):
        raise UserError(f"dataset {name}: grid is {str(grid)[:80]!r}, options with lists of values are needed")
    grid = {**grid, **seeds(item.get("repeat") or {})}
    stages = {kind: item[kind] for kind in KINDS if kind in item}
    facts = {key: value for key, value in item.items() if key not in ("grid", "repeat") and key not in stages}
    check_known(f"key of an item of dataset {name}", facts, FACTS)
    words = {fact: str(value) for fact, value in facts.items() if str(value).partition(".")[0] not in KINDS}
    chosen = {fact: [option] for fact, option in facts.items() if fact not in words}
    told: dict[str, Any] = dict(words)
    if "level" in words:
        told["level"] = _number(name, facts["level"])
    before = " ".join(str(word) for word in told.values())
    told.pop("label", None)
    return [
        {"label": f"{before} {member['label']}".strip()} | told | {key: member[key] for key in member if key != "label"}
        for member in _combinations(name, grid, chosen, merge(configuration, stages), {*stages})
    ]


def _combinations(
    name: str,
    grid: Mapping[str, list[Any]],
    facts: Mapping[str, list[str]],
    configuration: Configuration,
    beside: Iterable[str] = (),
) -> list[Item]:
    """The items of a grid: their labels and facts, and the stages whose options they set or that stand beside it."""
    for fact, options in facts.items():
        check_known(f"option of dataset {name} by which {fact} goes", options, grid)
    check_known(f"stage of dataset {name}", [option.partition(".")[0] for option in grid], KINDS)
    items: list[Item] = []
    for values in itertools.product(*grid.values()):
        chosen = dict(zip(grid, values, strict=True))
        kinds = dict.fromkeys([*beside, *(option.partition(".")[0] for option in grid)])
        stages = {kind: configuration.get(kind) for kind in kinds}
        for option, value in chosen.items():
            stages = assign(stages, option, value)
        told = {fact: " ".join(_said(chosen[option]) for option in options) for fact, options in facts.items()}
        known: Item = {fact: words for fact, words in told.items() if words}
        if "level" in known:
            known["level"] = _number(name, chosen[facts["level"][0]])
        items.append({"label": _label(chosen)} | known | stages)
    return items


def _number(name: str, value: Any) -> float:
    if isinstance(value, bool) or not isinstance(value, int | float):
        raise UserError(f"dataset {name}: the level is {value!r}, a number is needed")
    return float(value)


def _label(chosen: Mapping[str, Any]) -> str:
    """An item's values, with the names of their options where no word is among them."""
    if any(isinstance(value, str | Mapping) for value in chosen.values()):
        return " ".join(map(_said, chosen.values()))
    return ", ".join(f"{_word(option)} {_said(value)}" for option, value in chosen.items())


def _said(value: Any) -> str:
    """A value as a label says it: a name in words."""
    word = str(value.get("name", value)) if isinstance(value, Mapping) else str(value)
    return word.replace("_", " ") if isinstance(value, str) else word


def _word(option: str) -> str:
    return option.rpartition(".")[2].replace("_", " ")
