"""The default of an option stands once: in the function that computes, or in the plugin where that function has none."""

from __future__ import annotations

import ast
import inspect
import itertools
import sys
import textwrap
from collections.abc import Iterator, Mapping
from pathlib import Path
from types import CodeType
from typing import Annotated, Any, Literal

import numpy as np
import pytest
from pydantic import Field, ValidationError

from surfexp.lab.errors import UserError
from surfexp.lab.registry import registry
from surfexp.lab.registry.loading import load_all
from surfexp.lab.store.kinds import KINDS
from surfexp.mesh.shapes.icosphere import icosphere
from surfexp.mesh.surface import Surface
from surfexp.mesh.triangle_mesh import TriangleMesh
from surfexp.variational.models.deblurring import Deblurring

# the default of an experiment is another one than that of the function, for the reason given in docs/defaults.md
DIFFERENT = {
    "eigensolver/lobpcg: surface_spectrum(tolerance)",
    "feature/flux: flux_weights(alpha)",
    "statistic/energy_excess: primal_dual(tolerance)",
    "solver/conformal: primal_dual(tolerance)",
    "solver/conformal: sphere_grid_domain(columns)",
    "solver/patchwise: primal_dual(tolerance)",
    "surface/fsaverage5: fsaverage5(sheet)",
    "surface/labelled_fsaverage5: fsaverage5(sheet)",
    "surface/masked_fsaverage5: fsaverage5(sheet)",
    "statistic/level_set_parametrization: false_positive_share(halvings)",
    "statistic/level_set_parametrization: false_positive_share(permutations)",
    "statistic/width_test: false_positive_share(permutations)",
    "surface/file: read(labels)",
    "surface/file: read(maps)",
    "surface/file: read(path)",
}

INSIDE = ("<listcomp>", "<setcomp>", "<dictcomp>", "<genexpr>", "<lambda>")
OURS = ("surfexp.", "surfexp_studies.")


def declared_twice() -> Iterator[tuple[str, Any, Any]]:
    """Each option whose default stands in its plugin though a function that the plugin calls has one: what, both values."""
    load_all(Path("/nonexistent"))
    results = {kind.result for kind in KINDS.values()}
    for (kind, name), plugin in registry.PLUGINS.items():
        if kind == "figure" or name.startswith("toy_"):
            continue
        if Path(inspect.getfile(plugin.function)).resolve() != plugin.file:  # registered as it stands: one signature
            continue
        named = vars(sys.modules[plugin.function.__module__])
        called = {key: named.get(key) for key in names_read(plugin.function, named)}
        own = inspect.signature(plugin.function).parameters
        yield from renamed(f"{kind}/{name}", plugin, named)
        for function, value in called.items():
            if not (inspect.isfunction(value) or inspect.isclass(value)) or not value.__module__.startswith(OURS):
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


def names_read(function: Any, named: Mapping[str, Any], seen: frozenset[str] = frozenset()) -> Iterator[str]:
    """Names that a function reads, and those that helpers in its own file read in turn."""
    for name in names_in(function.__code__):
        yield name
        value = named.get(name)
        if inspect.isfunction(value) and value.__module__ == named["__name__"] and name not in seen:
            yield from names_read(value, named, seen | {name})


def names_in(code: CodeType) -> Iterator[str]:
    """Names that a function reads, its lambdas, generators and comprehensions too; some are functions of their own."""
    yield from code.co_names
    for constant in code.co_consts:
        if isinstance(constant, CodeType) and constant.co_name in INSIDE:
            yield from names_in(constant)


def renamed(where: str, plugin: registry.Plugin, named: dict[str, Any]) -> Iterator[tuple[str, Any, Any]]:
    """Each option that goes into a parameter of another name, where both have a default; every seed is 0 without one."""
    for call in ast.walk(ast.parse(textwrap.dedent(inspect.getsource(plugin.function)))):
        function = named.get(call.func.id) if isinstance(call, ast.Call) and isinstance(call.func, ast.Name) else None
        if not (inspect.isfunction(function) and function.__module__.startswith(OURS)):
            continue
        assert isinstance(call, ast.Call)
        given = {item.arg or "": item.value for item in call.keywords}
        names = inspect.signature(function).parameters
        plain = itertools.takewhile(lambda item: not isinstance(item, ast.Starred), call.args)
        given |= dict(zip(names, plain, strict=False))
        for parameter, value in given.items():
            option = value.id if isinstance(value, ast.Name) else ""
            if (
                option == parameter
                or parameter == "seed"
                or option not in plugin.options.model_fields
                or parameter not in names
            ):
                continue
            default, field = names[parameter].default, plugin.options.model_fields[option]
            if default is not inspect.Parameter.empty and not field.is_required():
                yield f"{where}: {function.__name__}({parameter}={option})", default, field.default


def test_no_default_stands_twice() -> None:
    assert not {file for file in registry.BROKEN if "plugins" in str(file)}
    found = {what: (first, second) for what, first, second in declared_twice()}
    assert not {what for what, (first, second) in found.items() if first == second}
    here = {what for what in DIFFERENT if tuple(what.partition(":")[0].split("/")) in registry.PLUGINS}
    assert set(found) == here, found


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


def ball(levels: int, radius: float = 1.0, hidden: int = 4) -> Surface:
    """A ball that no laboratory knows.

    Parameters
    ----------
    levels : int
        Subdivisions of the icosahedron.
    radius : float
    hidden : int
    """
    return icosphere(levels, radius * hidden)


def test_a_function_of_the_library_is_registered_as_it_stands(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(registry, "PLUGINS", {})
    chosen = {"levels": Field(1, ge=0, le=8), "radius": Annotated[Literal[1.0, 2.0], Field(description="in mm")]}
    assert registry.register("surface", "ball", options=chosen, names={"levels": "depth"})(ball) is ball
    method = registry.plugin("surface", "ball")
    fields = method.options.model_fields
    assert method.function is ball and method.file == Path(__file__).resolve()
    assert {name: field.default for name, field in fields.items()} == {"depth": 1, "radius": 1.0}
    assert fields["depth"].description == "Subdivisions of the icosahedron."
    assert np.array_equal(method({"radius": 2.0}).mesh.vertices, icosphere(1, 8.0).mesh.vertices)
    assert len(method({"depth": 0}).mesh.vertices) == 12
    for wrong in ({"depth": 9}, {"radius": 3.0}, {"hidden": 1}, {"levels": 1}):
        with pytest.raises(ValidationError):
            method(wrong)


def test_a_class_of_the_library_is_registered_as_it_stands(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(registry, "PLUGINS", {})
    registry.register("model", "blurred", options={"width": Field(gt=0), "mu": Field(gt=0)})(Deblurring)
    method = registry.plugin("model", "blurred")
    assert set(method.options.model_fields) == {"width", "mu"} and method.inputs == {}
    assert method({"width": 3.0}) == Deblurring(width=3.0) != Deblurring()
    with pytest.raises(ValidationError):
        method({"mu": 0.0})


def opposite(field: Mapping[str, Surface], first: Surface, *, count: int = 3) -> Surface:
    return field["a"] if count else first


def test_inputs_of_a_registered_function_are_found_by_their_types(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(registry, "PLUGINS", {})
    registry.register("surface", "opposite", options={"count": Field(ge=0)}, names={"field": "surfaces"})(opposite)
    method = registry.plugin("surface", "opposite")
    assert {role: (item.kind, item.shape) for role, item in method.inputs.items()} == {
        "surfaces": ("surface", "dict"),
        "first": ("surface", "one"),
    }
    one, other = icosphere(0), icosphere(1)
    assert method({}, surfaces={"a": one}, first=other) is one
    assert method({"count": 0}, surfaces={"a": one}, first=other) is other


@pytest.mark.parametrize(
    ("chosen", "names", "message"),
    [
        (
            {"levels": Field(), "radius": Field(2.0)},
            {},
            "the default of 'radius' stands here and in ball; leave it out",
        ),
        (
            {"levels": Field(), "radius": Field(1.0)},
            {},
            "the default of 'radius' stands here and in ball; leave it out",
        ),
        ({"level": Field()}, {}, "ball has no parameter 'level'; it has: levels, radius, hidden"),
        ({"levels": Field()}, {"depth": "levels"}, "ball has no parameter 'depth'"),
        ({"radius": Field()}, {}, "parameter 'levels' of ball has no default; name it in options="),
        ({"levels": 3}, {}, r"option 'levels' is Field\(...\) or Annotated\[type, Field\(...\)\], not 3"),
        ({"levels": Field(), "radius": Field()}, {"radius": "name"}, "option 'name' has the name of a stage kind"),
        ({"levels": Field(), "radius": Field()}, {"radius": "levels"}, "two parameters are called 'levels'"),
    ],
)
def test_a_wrong_registration_says_what_is_wrong(chosen: Any, names: dict[str, str], message: str) -> None:
    with pytest.raises(UserError, match=message):
        registry.register("surface", "wrong", options=chosen, names=names)(ball)


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


def rescaled(
    mesh: TriangleMesh, way: Literal["twice", "thrice"], factor: float = 1.0, *, told: object = None
) -> Surface:
    """A mesh made larger."""
    assert told is print
    return Surface(TriangleMesh(mesh.vertices * {"twice": 2, "thrice": 3}[way] * factor, mesh.faces), way)


def test_one_function_is_several_plugins_by_what_each_gives_it(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(registry, "PLUGINS", {})
    for way in ("twice", "thrice"):
        registry.register(
            "surface",
            way,
            given={"way": way, "told": print},
            options={"factor": Field(gt=0)},
            summary=f"It is {way} as large.",
        )(rescaled)
    method, ball = registry.plugin("surface", "thrice"), icosphere(1)
    assert method.summary == "It is thrice as large." and list(method.options.model_fields) == ["factor"]
    assert {role: item.kind for role, item in method.inputs.items()} == {"surface": "surface"}
    assert np.array_equal(method({"factor": 2.0}, surface=ball).mesh.vertices, ball.mesh.vertices * 6)
    assert np.array_equal(registry.plugin("surface", "twice")({}, surface=ball).mesh.vertices, ball.mesh.vertices * 2)
    with pytest.raises(UserError, match=r"rescaled has no parameter 'wya'; it has: mesh, way, factor, told"):
        registry.register("surface", "wrong", given={"wya": "twice"}, options={})(rescaled)
    with pytest.raises(ValidationError):
        method({"way": "twice"}, surface=ball)
