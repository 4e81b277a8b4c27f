"""The default of an option stands once: in the function that computes, or in the plugin where that function has none."""

from __future__ import annotations

import inspect
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Annotated, Any

import pytest
from pydantic import Field

from surfexp.lab.errors import UserError
from surfexp.lab.registry import registry
from surfexp.lab.registry.loading import load_all
from surfexp.lab.store.kinds import KINDS
from surfexp.mesh.shapes.icosphere import icosphere
from surfexp.mesh.surface import Surface

# the default of an experiment is another one than that of the function, for the reason given in docs/defaults.md
DIFFERENT = {
    "eigensolver/lobpcg: surface_spectrum(tolerance)",
    "feature/flux: flux_weights(alpha)",
    "measurement/energy_excess: primal_dual(tolerance)",
    "solver/conformal: primal_dual(tolerance)",
    "solver/conformal: sphere_grid_domain(columns)",
    "solver/patchwise: primal_dual(tolerance)",
    "statistic/level_set_parametrization: false_positive_share(halvings)",
    "statistic/level_set_parametrization: false_positive_share(permutations)",
    "statistic/width_test: false_positive_share(permutations)",
    "surface/file: read(labels)",
    "surface/file: read(maps)",
}


def declared_twice() -> Iterator[tuple[str, Any, Any]]:
    """Each option whose default stands in its plugin though a function that the plugin calls has one: what, both values."""
    load_all(Path("/nonexistent"))
    results = {kind.result for kind in KINDS.values()}
    for (kind, name), plugin in registry.PLUGINS.items():
        if kind == "figure" or name.startswith("toy_"):
            continue
        named = vars(sys.modules[plugin.function.__module__])
        called = {key: named.get(key) for key in plugin.function.__code__.co_names}
        own = inspect.signature(plugin.function).parameters
        for function, value in called.items():
            if not (inspect.isfunction(value) or inspect.isclass(value)) or not value.__module__.startswith("surfexp."):
                continue
            if value in results:  # what comes out has no settings
                continue
            for parameter in inspect.signature(value).parameters.values():
                if parameter.default is parameter.empty or parameter.name not in plugin.options.model_fields:
                    continue
                here = own[parameter.name].default
                effective = plugin.options.model_fields[parameter.name].default
                if here is not parameter.empty or effective != parameter.default:
                    yield f"{kind}/{name}: {function}({parameter.name})", parameter.default, effective


def test_no_default_stands_twice() -> None:
    assert not {file for file in registry.BROKEN if "plugins" in str(file)}
    found = {what: (first, second) for what, first, second in declared_twice()}
    assert {what for what, (first, second) in found.items() if first == second} == set()
    assert set(found) == DIFFERENT, found


def test_defaults_come_from_the_function_that_computes(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(registry, "PLUGINS", {})

    @registry.register("surface", "ball", defaults_of=icosphere)
    def ball(*, levels: Annotated[int, Field(ge=0, le=8)], radius: float) -> Surface:
        """A ball.

        Parameters
        ----------
        levels : int
            Subdivisions
            of the icosahedron.
        radius : float
            In any unit.
        """
        return icosphere(levels, radius)

    method = registry.plugin("surface", "ball")
    fields = method.options.model_fields
    parameters = inspect.signature(icosphere).parameters
    assert {name: field.default for name, field in fields.items()} == {
        name: parameters[name].default for name in ("levels", "radius")
    }
    assert fields["levels"].description == "Subdivisions of the icosahedron."
    assert method.inputs == {}
    assert len(method({"levels": 1}).mesh.vertices) == 42


def test_the_same_default_twice_is_refused() -> None:
    def ball(*, levels: int = inspect.signature(icosphere).parameters["levels"].default) -> Surface:
        return icosphere(levels)

    with pytest.raises(UserError, match=r"the default of 'levels' stands here and in icosphere; leave it out here"):
        registry.register("surface", "twice", defaults_of=icosphere)(ball)


def test_the_old_form_is_refused_with_the_new_one() -> None:
    from pydantic import BaseModel

    class Ball(BaseModel):
        levels: int = 3

    def ball(options: Ball) -> Surface:
        return icosphere(options.levels)

    ball.__annotations__ = {"options": Ball, "return": Surface}
    with pytest.raises(UserError, match=r"options are parameters of the function, not the model Ball: def f\("):
        registry.register("surface", "old", defaults_of=icosphere)(ball)


@pytest.mark.parametrize("annotation", [None, object])
def test_a_parameter_that_is_neither_input_nor_plain_value_is_refused(annotation: Any) -> None:
    def ball(values):  # type: ignore[no-untyped-def]
        return values

    ball.__annotations__ = {"values": annotation} if annotation else {}
    if annotation is object:
        ball.__annotations__ = {"values": type("Matrix", (), {})}
    with pytest.raises(UserError, match="values"):
        registry.register("surface", "neither")(ball)
