"""What `surfexp new` writes: plugin files to start from and their tests. Each works before a line of it is changed."""

from __future__ import annotations

PLUGIN = '''"""{title}."""

from pydantic import Field

{imports}
from surfexp.workflow.registry import Options, register


class {model}(Options):
    """The options of {name}."""

    strength: float = Field(1.0, gt=0, description="say what it is, with its unit")


@register("{kind}", "{name}")
def {name}(
    options: {model},
{parameters}) -> {result}:
    """{title}: one sentence that `surfexp list {kind}` will show."""
    raise NotImplementedError("it computes nothing yet: edit its file")
'''

PLUGIN_TEST = '''"""Test of {kind}/{name}: replace it by an identity or an exact solution."""

from pathlib import Path

from surfexp.workflow import registry

NAME = "{name}"
PLUGIN = "{path}"


def test_it_is_registered_with_documented_options() -> None:
    registry.load_file(Path(PLUGIN))
    options = registry.plugin("{kind}", NAME).options
    assert all(field.description for field in options.model_fields.values())
'''

SOLVER = '''"""{title}: projected gradient ascent on the dual problem, to start from."""

from collections.abc import Iterator
from functools import partial

import numpy as np
from pydantic import Field

from surfexp.operators.calculus import adjoint_gradient, gradient
from surfexp.operators.surface_operator import SurfaceOperator
from surfexp.variational.duality_gap import Iterate, run_to_gap
from surfexp.variational.fidelity import Fidelity, Progress
from surfexp.variational.image import Image
from surfexp.variational.model import Model
from surfexp.variational.solution import Solution
from surfexp.variational.solvers.face_sweeps import face_steps
from surfexp.workflow.registry import Options, register
from surfexp.workflow.stage import report_progress

NAME = "{name}"
CHECK_INTERVAL = 25


class {model}(Options):
    """When to stop."""

    tolerance: float = Field(1e-4, gt=0, lt=1, description="bound of the relative gap")
    iteration_limit: int = Field(20000, ge=1, description="most iterations")


@register("solver", NAME, accepts={{"model": ("rof",)}})
def {name}_solver(
    options: {model},
    *,
    image: Image,
    operator: SurfaceOperator,
    model: Model,
) -> Solution:
    """{title}: one sentence that `surfexp list solver` will show."""
    rest = {{**dict(options), "progress": report_progress}}
    return model.run(image, operator, partial({name}, **rest))


def {name}(
    fidelity: Fidelity,
    operator: SurfaceOperator,
    start: Solution | None = None,
    *,
    tolerance: float | None = None,
    iteration_limit: int = 20000,
    progress: Progress | None = None,
) -> Solution:
    """Minimise TV + H, H strongly convex.

    `run_to_gap` takes iterates until their energy is proved to be within `tolerance` of
    the least one: a field of values, a dual field with |p| <= 1 on every face, and its
    load G^T A p are all that it needs.
    """
    iterates = _iterates(fidelity, operator, start, iteration_limit)
    return run_to_gap(iterates, fidelity, operator, NAME, tolerance, progress)


def _iterates(
    fidelity: Fidelity,
    operator: SurfaceOperator,
    start: Solution | None,
    limit: int,
) -> Iterator[Iterate]:
    dual = np.zeros((len(operator.faces), 2))
    if start is not None and start.dual is not None:
        dual = start.dual.copy()
    steps = fidelity.strong_convexity * face_steps(operator.hat_gradients)
    for iteration in range(1, limit + 1):
        load = adjoint_gradient(operator, dual)
        values = fidelity.primal_from_dual(load)
        assert values is not None
        if iteration % CHECK_INTERVAL == 0 or iteration == limit:
            yield Iterate(iteration, values, dual, load)
        dual = dual + steps[:, None] * gradient(operator, values)
        dual /= np.maximum(1.0, np.linalg.norm(dual, axis=1, keepdims=True))
'''

SOLVER_TEST = '''"""{title} finds the minimiser of Newton's method, with a certificate."""

from pathlib import Path

import numpy as np
import pytest

from surfexp.mesh.shapes.icosphere import icosphere
from surfexp.operators.calculus import gradient_matrix
from surfexp.operators.fem import fem
from surfexp.variational.image import Image
from surfexp.variational.models.rof import ROF
from surfexp.variational.solvers.newton import newton
from surfexp.workflow import registry

NAME = "{name}"
PLUGIN = "{path}"
MU = 20.0
MESH = icosphere(2).mesh
OPERATOR = fem(MESH)
NOISE = np.random.default_rng(0).standard_normal(len(MESH.vertices))
IMAGE = Image(np.sign(MESH.vertices[:, 2]) + 0.2 * NOISE)


@pytest.fixture(scope="module")
def found():
    registry.load_file(Path(PLUGIN))
    method = registry.plugin("solver", NAME)
    options = method.options(tolerance=1e-6)
    return method.function(options, image=IMAGE, operator=OPERATOR, model=ROF(mu=MU))


def test_it_finds_the_minimiser_of_newton(found) -> None:
    exact = ROF(mu=MU).run(IMAGE, OPERATOR, newton)
    distance = np.sqrt(OPERATOR.mass @ (found.values - exact.values) ** 2)
    assert found.converged
    assert distance <= found.error_bound + exact.error_bound
    assert found.energy == pytest.approx(exact.energy, rel=1e-6)


def test_its_certificate_holds(found) -> None:
    """Energy and lower bound computed again, by a matrix and by the formulas."""
    matrix, mass, image = gradient_matrix(OPERATOR), OPERATOR.mass, IMAGE.values
    lengths = np.linalg.norm((matrix @ found.values).reshape(-1, 2), axis=1)
    distance = 0.5 * MU * mass @ (found.values - image) ** 2
    assert found.energy == pytest.approx(OPERATOR.areas @ lengths + distance, rel=1e-10)

    assert np.linalg.norm(found.dual, axis=1).max() <= 1.0 + 1e-12
    load = matrix.T @ (np.repeat(OPERATOR.areas, 2) * found.dual.ravel())
    lower_bound = load @ image - 0.5 * (load**2 / (MU * mass)).sum()
    assert found.lower_bound == pytest.approx(lower_bound, rel=1e-10)
    assert lower_bound <= found.energy
'''

KIND = '''"""The stage kind {name}: its result, and a first method that gives one."""

from dataclasses import dataclass, field
from typing import ClassVar

import numpy as np
from pydantic import Field

from surfexp.arrays import Floats
from surfexp.mesh.surface import Surface
from surfexp.metric import Metric
from surfexp.workflow.kinds import stage_kind
from surfexp.workflow.registry import Options, register


@dataclass(frozen=True, eq=False)
class {result}:
    """What a {name} is: say it in a sentence.

    Parameters
    ----------
    values : (n,) float64
        One value a vertex. Shapes that stand here are checked.
    metrics : dict of str to float
        What tables show.
    notes : tuple of str
        What a reader must know.
    """

    values: Floats
    metrics: dict[str, float] = field(default_factory=dict)
    notes: tuple[str, ...] = ()
    METRICS: ClassVar[dict[str, Metric]] = {{"largest": Metric("largest value")}}


stage_kind("{name}", {result})


class Height(Options):
    """The options of the first method."""

    scale: float = Field(1.0, gt=0, description="factor of every value")


@register("{name}", "height")
def height(options: Height, *, surface: Surface) -> {result}:
    """The third coordinate, to start from."""
    values = np.array(options.scale * surface.mesh.vertices[:, 2])
    return {result}(values, {{"largest": float(values.max())}})
'''

KIND_TEST = '''"""The stage kind {name} is planned, made, stored and read back."""

from pathlib import Path

import numpy as np

from surfexp.workflow import registry, stage, store
from surfexp.workflow.plan import make_plan

KIND = "{name}"
PLUGIN = "{path}"


def test_it_is_made_and_read_back(tmp_path: Path) -> None:
    registry.load_all(Path("nowhere"))
    registry.load_file(Path(PLUGIN))
    configuration = {{
        "experiment": "first",
        "target": KIND,
        "results": str(tmp_path),
        "surface": {{"name": "icosphere", "levels": 1}},
        KIND: {{"name": "height", "scale": 2.0}},
    }}
    plan = make_plan([configuration])
    path = plan.write(tmp_path)
    for key in plan.nodes:
        assert stage.run_stage(path, key) == 0
    result = store.load(tmp_path, KIND, plan.leaves[0].key)
    assert result.metrics["largest"] == np.max(result.values) == 2.0
'''
