"""A plugin as a person or Hydra asks for it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any


@dataclass(frozen=True)
class Described:
    """A plugin as a person or Hydra asks for it.

    `options` are rows (name, default, values, meaning); `defaults` is what Hydra composes, "???" where an option is
    required; `inputs` are kind and shape by role, `accepts` the plugins that may feed a kind.
    """

    kind: str
    name: str
    file: str
    summary: str
    inputs: dict[str, list[str]]
    accepts: dict[str, list[str]]
    options: list[list[str]]
    defaults: dict[str, Any]
