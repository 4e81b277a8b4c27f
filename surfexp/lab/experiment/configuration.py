"""The composed configuration: its schema, how variants and grids expand it, how partial configurations merge."""

from __future__ import annotations

import itertools
from collections import Counter
from collections.abc import Mapping, Sequence
from typing import Any, Literal

from pydantic import BaseModel, ConfigDict, Field, PositiveFloat, ValidationError
from typing_extensions import TypedDict

from surfexp.lab.errors import UserError, check_known, unknown
from surfexp.lab.registry.registry import plugin
from surfexp.lab.store.kinds import KINDS

Context = dict[str, Any]
# kinds that have another name now
RENAMED = {"measurement": "statistic"}
NAME = r"^[A-Za-z0-9][\w.-]*$"
Item = TypedDict("Item", {"label": str, "class": str, "group": str, "level": float}, total=False)
Item.__pydantic_config__ = ConfigDict(extra="allow", coerce_numbers_to_str=True)  # type: ignore[attr-defined]


class Settings(BaseModel):
    """Everything at the top level of a configuration that is not a stage."""

    model_config = ConfigDict(extra="forbid")

    experiment: str = Field("unnamed", pattern=NAME, max_length=100, description="folder of its pages")
    title: str = Field("", description="heading of the report page")
    chapter: tuple[int, int] | None = Field(None, description="of the dissertation, and the place in its list")
    start: int | None = Field(None, description="place among the experiments to begin with")
    description: str = Field("", description="paragraph below the heading")
    results: str = Field("results", description="folder of all output")
    cores: int | None = Field(None, ge=1, description="processors for Snakemake; default: all")
    profile: str | None = Field(None, description="Snakemake profile, e.g. profiles/slurm")
    resources: dict[Literal["time", "memory"], PositiveFloat | None] = Field({}, description="limits of a stage: s, MB")
    timing: bool = Field(
        False, description="benchmark mode: one job at a time; the median of the calls after the first counts"
    )
    target: str = Field("solver", description="stage kind at the end of each chain")
    comparison: str = Field("", description="heading of the table that a variant belongs to")
    caption: str = Field("", description="sentence below that table")
    columns: list[str] = Field([], description="metrics of the table, in order; empty: all")
    figures: list[Any] = Field([], description="figure plugins drawn for each variant: a name, or name and options")
    objective: str | None = Field(None, description="metric that an optimising sweeper minimises")
    claims: list[Any] = Field([], description="published claims, each judged from the rows of the report")
    datasets: dict[str, list[Item]] = Field({}, description="items by dataset: label, facts, stages")
    variants: list[Any] = Field([], description="partial configurations, each with its own grid; their union is run")
    grid: dict[str, list[Any]] = Field({}, description="dotted option to list of values; every combination is run")


def settings_of(configuration: Mapping[str, Any]) -> Settings:
    """Check the top level of a configuration; UserError naming the nearest valid key."""
    for key in (*configuration, configuration.get("target")):
        if key in RENAMED and key not in KINDS:
            raise UserError(
                f"{key!r} is called {RENAMED[key]!r} now: write {RENAMED[key]}: PLUGIN, target: {RENAMED[key]}"
            )
    check_known("configuration key", configuration, [*Settings.model_fields, *KINDS])
    try:
        settings = Settings(**{key: value for key, value in configuration.items() if key in Settings.model_fields})
    except ValidationError as error:
        raise UserError(one_line("configuration", error)) from None
    for name, items in settings.datasets.items():
        _check_labels(name, items)
    return settings


def _check_labels(name: str, items: Sequence[Mapping[str, Any]]) -> None:
    """Refuse a dataset in which two items have one label: a method would get one of them."""
    labels = Counter(item.get("label", str(number)) for number, item in enumerate(items))
    for label, count in labels.items():
        if count > 1:
            ways = "give each a label of its own, leave out one of two equal values, or tell grids apart by class: WORD"
            raise UserError(f"dataset {name}: {count} items are called {label!r}; {ways}")


def one_line(where: str, error: ValidationError) -> str:
    """The first complaint of pydantic with the thing, its value and the bound, in one line."""
    first = error.errors()[0]
    path = ".".join([where, *(str(part) for part in first["loc"])])
    if first["type"] == "missing" and isinstance(first["loc"][-1], int):
        return f"{path.rpartition('.')[0]} has {first['loc'][-1]} values, more are needed"
    if first["type"] == "missing":
        return f"{path} is required; set {path.partition('/')[0]}.{first['loc'][-1]}=VALUE"
    return f"{path} = {first.get('input')!r}: {first['msg']}"


def stage(value: Any) -> Context:
    """Normal form of a stage's configuration: a bare name becomes a mapping."""
    if not isinstance(value, str | Mapping):
        raise UserError(f"stage configuration {value!r}: expected a plugin name or a mapping with 'name'")
    return {"name": value} if isinstance(value, str) else dict(value)


def merge(base: Mapping[str, Any], partial: Mapping[str, Any]) -> Context:
    """Lay a partial configuration over another; naming another plugin for a stage drops the old one's options."""
    merged = dict(base)
    for key, value in partial.items():
        if key in KINDS and value is not None:
            old, new = stage(merged.get(key) or {}), stage(value)
            keep = "name" not in new or new["name"] == old.get("name")
            merged[key] = {**old, **new} if keep else new
        else:
            merged[key] = value
    return merged


def assign(configuration: Context, dotted: str, value: Any) -> Context:
    """A copy with one dotted option set."""
    head, _, rest = dotted.partition(".")
    if not rest:
        return merge(configuration, {head: value})
    inner = stage(configuration.get(head) or {}) if head in KINDS else dict(configuration.get(head) or {})
    return {**configuration, head: assign(inner, rest, value)}


def expand(configuration: Context, overrides: Mapping[str, Any] | None = None) -> list[Context]:
    """All leaf configurations of one composed configuration: the union over variants of their grids.

    `overrides` is what the command line says of stages: a kind's configuration, or an option's value under its dotted
    name. It wins over variants and grids; an option goes to every plugin that has it, whichever comes first. Leaves share
    what they have in common: nobody may change one.
    """
    base = {key: value for key, value in configuration.items() if key not in ("variants", "grid")}
    leaves = []
    for variant in configuration.get("variants") or [{}]:
        partial = {key: value for key, value in variant.items() if key != "grid"}
        grid = {**(configuration.get("grid") or {}), **(variant.get("grid") or {})}
        for values in itertools.product(*grid.values()):
            leaf = merge(base, partial)
            for dotted, value in zip(grid, values, strict=True):
                leaf = assign(leaf, dotted, value)
            leaves.append(leaf)
    for dotted, value in sorted((overrides or {}).items(), key=lambda item: "." in item[0]):
        leaves = _override(leaves, dotted, value)
    return leaves


def _override(leaves: list[Context], dotted: str, value: Any) -> list[Context]:
    kind, _, option = dotted.partition(".")
    if kind not in KINDS:
        return [assign(leaf, dotted, value) for leaf in leaves]
    if not option:
        return [{**leaf, kind: value} for leaf in leaves]
    names = [str(stage(leaf[kind]).get("name")) if leaf.get(kind) else None for leaf in leaves]
    options = {name: set(plugin(kind, name).options.model_fields) | {"inputs"} for name in names if name}
    if not any(option.partition(".")[0] in known for known in options.values()):
        raise _no_such_option(kind, option, options)
    applies = [name is not None and option.partition(".")[0] in options[name] for name in names]
    return [assign(leaf, dotted, value) if here else leaf for leaf, here in zip(leaves, applies, strict=True)]


def _no_such_option(kind: str, option: str, options: Mapping[str, set[str]]) -> UserError:
    """Say that no chosen plugin of a kind has an option; `options` are those of the chosen ones."""
    if not options:
        way_out = f"add {kind}=NAME (surfexp list {kind} names them, surfexp info {kind}/NAME their options)"
        return UserError(f"{kind}.{option}: the experiment chooses no {kind}; {way_out}")
    thing = f"{kind}/{next(iter(options))}" if len(options) == 1 else kind
    if known := set().union(*options.values()) - {"inputs"}:
        return unknown(f"option of {thing}", option, known)
    return UserError(f"unknown option of {thing} {option!r}: it has no options")
