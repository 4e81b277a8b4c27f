"""Inputs and options read from the signature of a function that is registered as it stands."""

from __future__ import annotations

import inspect
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any

import numpy as np
import pytest
from pydantic import Field

from surfexp.contract.member import Member
from surfexp.embedding.distance import Distance
from surfexp.lab.errors import UserError
from surfexp.lab.registry.catalogue import open_catalogue
from surfexp.lab.registry.registry import plugin
from surfexp.lab.registry.signature import options_and_inputs
from surfexp.mesh.shapes.icosphere import icosphere
from surfexp.mesh.surface import Surface
from surfexp.operators.fem import fem
from surfexp.spectrum.eigensystem import EigenSystem
from surfexp.spectrum.surface_spectrum import surface_spectrum
from surfexp.variational.image import Image
from surfexp.variational.model import Model, solver_of_models
from surfexp.variational.models.rof import ROF
from surfexp.variational.solution import Solution
from surfexp.variational.solvers.primal_dual import primal_dual


@dataclass(frozen=True)
class Sides:
    left: Surface
    right: Surface


@dataclass(frozen=True)
class Mixed:
    left: Surface
    factor: float


def between(sides: Sides, n: int = 3) -> Distance:
    raise NotImplementedError


def of_mixed(mixed: Mixed, n: int = 3) -> Distance:
    raise NotImplementedError


def read(function: Any, **words: Any) -> Any:
    return options_and_inputs("plugin distance/x", function, (), words.get("options"), {}, {})


def test_the_fields_of_a_dataclass_of_results_are_inputs() -> None:
    options, inputs = read(between, options={"n": Field(ge=1, description="modes")})
    assert {role: (item.kind, item.group) for role, item in inputs.items()} == {
        "left": ("surface", "sides"),
        "right": ("surface", "sides"),
    }
    assert list(options.model_fields) == ["n"] and options().n == 3  # type: ignore[attr-defined]


def test_a_dataclass_with_a_number_is_no_group() -> None:
    with pytest.raises(UserError, match="parameter 'mixed' of of_mixed has no default"):
        read(of_mixed, options={"n": Field(ge=1, description="modes")})


def test_a_member_is_no_group_of_results() -> None:
    def of(member: Member, n: Annotated[int, Field(ge=1)] = 1) -> Distance:
        raise NotImplementedError

    assert not read(of)[1]


def test_a_plugin_of_a_pair_equals_the_function_of_the_pair() -> None:
    open_catalogue(Path.cwd())
    ball = icosphere(2)
    system = surface_spectrum(ball, fem(ball.mesh), 8)
    inputs: dict[str, Surface | EigenSystem] = {
        "source_surface": ball, "target_surface": ball, "source": system, "target": system,
    }  # fmt: skip
    found = plugin("distance", "vertex_index")({"n": 4}, **inputs)
    assert np.array_equal(found.correspondence, np.arange(len(ball.mesh.vertices)))
    assert plugin("distance", "vertex_index").inputs.keys() == inputs.keys()


def test_a_solver_of_models_has_the_options_of_its_method_and_solves_the_model() -> None:
    made = solver_of_models(primal_dual)
    described = inspect.signature(made).parameters
    assert list(described)[:3] == ["image", "operator", "model"]
    own = {
        name: item for name, item in inspect.signature(primal_dual).parameters.items() if item.kind is item.KEYWORD_ONLY
    }
    assert {name: described[name].default for name in own} == {name: item.default for name, item in own.items()}
    assert described["model"].annotation is Model and inspect.signature(made).return_annotation is Solution
    ball = icosphere(2)
    operator = fem(ball.mesh)
    image = Image(ball.mesh.vertices[:, 2], noise=0.1)
    direct = ROF().run(image, operator, primal_dual)
    assert np.array_equal(made(image, operator, ROF(), tolerance=None).values, direct.values)
    with pytest.raises(TypeError, match="tolerence"):
        made(image, operator, ROF(), tolerence=1.0)
