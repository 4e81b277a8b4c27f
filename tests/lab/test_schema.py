"""The schema of experiments stands alone: what a model defines elsewhere is written where it is used."""

from __future__ import annotations

from typing import Any

from pydantic import BaseModel

from surfexp.lab.experiment.schema import _model


class Inner(BaseModel):
    share: float = 0.5


class Outer(BaseModel):
    one: Inner = Inner()
    many: list[Inner] = []


def keys(part: Any) -> set[str]:
    if isinstance(part, dict):
        return set(part).union(*map(keys, part.values()))
    return set().union(*map(keys, part)) if isinstance(part, list) else set()


def test_references_are_written_out() -> None:
    schema = _model(Outer)
    assert not keys(schema) & {"$ref", "$defs"}
    for inner in (schema["properties"]["one"], schema["properties"]["many"]["items"]):
        assert inner["properties"]["share"]["type"] == "number"
