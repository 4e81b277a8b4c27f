"""What a run of MLflow shows, and what of one is asked for, whichever way it is written."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

LONGEST_PARAMETER, LONGEST_TAG = 6000, 8000  # MLflow's own limits


@dataclass(frozen=True)
class RunDataset:
    """A surface or an image that a run starts from: its name, its key in the store, where it lies, its size in words."""

    name: str
    digest: str
    source: str
    profile: str


@dataclass(frozen=True)
class RunContent:
    """All that a run shows. `series` are metrics as (name, step, value); the last step of each is its value.

    `seconds` are those of the computation: what the dashboard calls the duration of the run.
    """

    name: str
    status: str
    seconds: float
    parameters: Mapping[str, str]
    series: Sequence[tuple[str, int, float]]
    tags: Mapping[str, str]
    datasets: Sequence[RunDataset] = ()


@dataclass(frozen=True)
class KnownRun:
    """A run in the database, with those of its tags that were asked for."""

    identity: str
    status: str
    tags: dict[str, str] = field(default_factory=dict)
