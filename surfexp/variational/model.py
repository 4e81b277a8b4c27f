"""What every variational model offers to a solver's job."""

from __future__ import annotations

import inspect
from collections.abc import Callable
from functools import partial
from typing import Any, Protocol, get_type_hints, runtime_checkable

from surfexp.operators.surface_operator import SurfaceOperator
from surfexp.variational.fidelity import Method
from surfexp.variational.image import Image
from surfexp.variational.solution import Solution


@runtime_checkable
class Model(Protocol):
    """A variational model min TV(phi) + H(phi), solved once or in an outer loop: a frozen dataclass of parameters."""

    def run(self, image: Image, operator: SurfaceOperator, method: Method) -> Solution:
        """Solve the model for an image; `method(fidelity, operator, start)` solves one convex problem."""
        ...


def solver_of_models(method: Callable[..., Any]) -> Callable[..., Solution]:
    """Return `method`, which solves one convex problem, as a function of image, operator and model with the same options.

    Parameters
    ----------
    method : callable
        Of the convex problem, and of options by keyword alone.

    Returns
    -------
    callable
        Of `image`, `operator`, `model` and these options, with their types and defaults; it returns what `model.run` does.
    """

    def solver(image: Image, operator: SurfaceOperator, model: Model, **options: Any) -> Solution:
        return model.run(image, operator, partial(method, **options))

    hints = get_type_hints(method, include_extras=True)
    parts = [item for item in inspect.signature(solver, eval_str=True).parameters.values() if item.name != "options"]
    keywords = [
        item.replace(annotation=hints[item.name])
        for item in inspect.signature(method).parameters.values()
        if item.kind is item.KEYWORD_ONLY
    ]
    found = inspect.Signature([*parts, *keywords], return_annotation=Solution)
    solver.__signature__ = found  # type: ignore[attr-defined]
    solver.__annotations__ = {name: item.annotation for name, item in found.parameters.items()} | {"return": Solution}
    solver.__name__ = solver.__qualname__ = method.__name__
    solver.__doc__ = method.__doc__
    return solver
