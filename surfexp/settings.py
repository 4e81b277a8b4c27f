"""What can be set at the top level of a configuration."""

from __future__ import annotations

from typing import Any

from pydantic import BaseModel, ConfigDict, Field
from typing_extensions import TypedDict

Facts = TypedDict("Facts", {"class": str, "group": str, "level": float}, total=False)
Facts.__pydantic_config__ = ConfigDict(extra="allow", coerce_numbers_to_str=True)  # type: ignore[attr-defined]


class Settings(BaseModel):
    """Everything at the top level of a configuration that is not a stage."""

    model_config = ConfigDict(extra="forbid")

    experiment: str = Field("unnamed", description="name of the experiment: its folder in results and in the dashboard")
    title: str = Field("", description="heading of the report page")
    description: str = Field("", description="paragraph below the heading")
    results: str = Field("results", description="folder of all output")
    cores: int | None = Field(None, ge=1, description="processors for Snakemake; default: all")
    profile: str | None = Field(None, description="Snakemake profile, e.g. profiles/slurm")
    timing: bool = Field(False, description="clocks matter: one job at a time, leaves computed anew each time")
    target: str = Field("solver", description="stage kind at the end of each chain")
    comparison: str = Field("", description="heading of the table that a variant belongs to")
    caption: str = Field("", description="sentence below that table")
    columns: list[str] = Field([], description="metrics of the table, in order; empty: all")
    figures: list[Any] = Field([], description="figure plugins drawn for each variant: a name, or name and options")
    objective: str | None = Field(None, description="metric that an optimising sweeper minimises")
    claims: list[Any] = Field([], description="published claims, each judged from the rows of the report")
    axes: dict[str, dict[Any, Facts] | list[Facts]] = Field({}, description="collections: label, facts, stages")
    variants: list[Any] = Field([], description="partial configurations, each with its own grid; their union is run")
    grid: dict[str, list[Any]] = Field({}, description="dotted option to list of values; every combination is run")
