"""A default that a plugin's options and the function behind them both declare is the same in both places."""

from __future__ import annotations

import inspect
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from pydantic_core import PydanticUndefined

from surfexp.lab.registry import registry
from surfexp.lab.registry.loading import load_all

# where an experiment needs another number than a person who calls the function
DIFFERENT = {
    "eigensolver/lobpcg: surface_spectrum(tolerance)",
    "feature/flux: flux_weights(alpha)",
    "solver/chambolle_dual: published_chambolle(iteration_limit)",
    "solver/conformal: primal_dual(tolerance)",
    "solver/conformal: sphere_grid_domain(columns)",
    "statistic/energy_excess: primal_dual(tolerance)",
    "solver/geodesic_curvature_flow: geodesic_curvature_flow(steps)",
    "solver/patchwise: primal_dual(tolerance)",
    "solver/split_bregman: published_split_bregman(iteration_limit)",
    "statistic/level_set_parametrization: false_positive_share(halvings)",
    "statistic/level_set_parametrization: false_positive_share(permutations)",
    "statistic/sulci_names: name_regions(sizes)",
    "statistic/width_test: false_positive_share(permutations)",
    "surface/cingulate: cingulate(refine)",
    "surface/clover: clover(levels)",
    "surface/drum: tile_mesh(grading)",
    "surface/rectangle: rectangle(width)",
}


def declared_twice() -> Iterator[tuple[str, Any, Any]]:
    """Each default that stands in a function which a plugin calls and in its options: what it is, and both values."""
    load_all(Path("/nonexistent"))
    for (kind, name), plugin in registry.PLUGINS.items():
        named = {
            key: vars(sys.modules[plugin.function.__module__]).get(key) for key in plugin.function.__code__.co_names
        }
        functions = {key: value for key, value in named.items() if inspect.isfunction(value)}
        for function, value in functions.items():
            if kind == "figure" or not value.__module__.startswith("surfexp."):
                continue
            for parameter in inspect.signature(value).parameters.values():
                field = plugin.options.model_fields.get(parameter.name)
                defaults = (parameter.default, getattr(field, "default", PydanticUndefined))
                if parameter.default is not parameter.empty and defaults[1] is not PydanticUndefined:
                    yield f"{kind}/{name}: {function}({parameter.name})", *map(comparable, defaults)


def comparable(value: Any) -> Any:
    if value == {}:
        return None
    return tuple(value) if isinstance(value, list) else value


def test_a_default_that_stands_twice_is_the_same_twice() -> None:
    found = list(declared_twice())
    assert len(found) > 300
    assert {what for what, first, second in found if first != second} == DIFFERENT
