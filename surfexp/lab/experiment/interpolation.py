"""Interpolations of a configuration: what another key says may be asked for, the environment and the clock may not."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from typing import Any

from omegaconf import DictConfig, OmegaConf

from surfexp.lab.errors import UserError

# a resolver is a function with a name before a colon, nested ones included: ${oc.env:HOME}, ${${name}:x}
RESOLVER = re.compile(r"\$\{(?:[^{}]|\{[^{}]*\})*?:")


def resolved(config: DictConfig) -> Any:
    """Return a configuration as dictionaries and lists, with what its keys say of each other filled in.

    Parameters
    ----------
    config : DictConfig
        Perhaps a file of a stranger.

    Raises
    ------
    UserError
        If a value calls a resolver, such as the environment's; what it would say is not looked up.
    """
    for path, text in _texts(OmegaConf.to_container(config, resolve=False), ""):
        if RESOLVER.search(text):
            raise UserError(
                f"{path} is {text[:80]!r}, which asks for more than the configuration says: write the value, or ${{KEY}}"
            )
    return OmegaConf.to_container(config, resolve=True, throw_on_missing=False)


def _texts(value: Any, path: str) -> Iterator[tuple[str, str]]:
    """Every text of a configuration, keys too, with the place where it stands."""
    if isinstance(value, Mapping):
        for key, item in value.items():
            yield f"{path}.{key}".lstrip("."), str(key)
            yield from _texts(item, f"{path}.{key}".lstrip("."))
    elif isinstance(value, list):
        for number, item in enumerate(value):
            yield from _texts(item, f"{path}.{number}")
    elif isinstance(value, str):
        yield path, value
