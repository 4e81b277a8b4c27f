"""What every variational model offers to a solver's job."""

from __future__ import annotations

from typing import Protocol, runtime_checkable

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
