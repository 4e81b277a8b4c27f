"""What a solver returns: the field, its dual, its history and its certificate."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import ClassVar

from surfexp.contract.arrays import Floats
from surfexp.contract.metric import Metric


@dataclass(frozen=True, eq=False)
class Solution:
    """The result of a variational solver.

    Parameters
    ----------
    values : (n,) or (n, c) float64
        The minimiser that was found; the certificate belongs to exactly this array.
    energy : float
        Primal energy of `values` under the consistent discretisation.
    dual : (m, 2) or (m, c, 2) float64, optional
        A feasible dual field, |p| <= 1 on every face, that proves the gap.
    lower_bound : float, optional
        Dual energy of `dual`: no field has less energy.
    relative_gap : float, optional
        (energy - lower_bound) / scale, the quantity that the tolerance bounds; `Fidelity.gap_scale` is the scale.
    error_bound : float, optional
        sqrt(2 gap / mu), the largest possible mass-norm distance to the exact minimiser; None unless the fidelity is
        strongly convex.
    iterations : int
    converged : bool
    reason : str
        Why it stopped: "gap below tolerance", "iteration limit", ...
    history : dict of str to (k,) float64
        "iteration", "energy", "gap", one entry each time they were evaluated.
    model, solver : str
        Names for captions.
    segmentation : (n,) bool-like float64, optional
        The labelling that a segmentation model derives from `values`.
    metrics : dict of str to float
    notes : tuple of str
        As in `Surface`.
    """

    values: Floats
    energy: float
    dual: Floats | None = None
    lower_bound: float | None = None
    relative_gap: float | None = None
    error_bound: float | None = None
    iterations: int = 0
    converged: bool = True
    reason: str = ""
    history: dict[str, Floats] = field(default_factory=dict)
    model: str = ""
    solver: str = ""
    segmentation: Floats | None = None
    metrics: dict[str, float] = field(default_factory=dict)
    notes: tuple[str, ...] = ()
    METRICS: ClassVar[dict[str, Metric]] = {
        "energy": Metric("energy under the consistent discretisation"),
        "lower_bound": Metric("proved lower bound of the energy", better="higher"),
        "gap": Metric("energy above its proved lower bound", better="lower"),
        "relative_gap": Metric(
            "energy above its proved lower bound, over the scale of the model", "", "lower", "tolerance"
        ),
        "error_bound": Metric("largest possible distance to the exact minimiser, mass norm", better="lower"),
        "iterations": Metric("iterations, of all outer updates together", better="lower"),
        "converged": Metric("1 where the tolerance was reached, else 0", better="higher"),
    }

    def __post_init__(self) -> None:
        """Count `converged` among the metrics: 1 or 0."""
        object.__setattr__(self, "metrics", {**self.metrics, "converged": float(self.converged)})

    @property
    def boundary(self) -> tuple[Floats, float]:
        """The field and the level at which its level line bounds the regions: `values` at metric "threshold", where given.

        Raises
        ------
        ValueError
            If there are no regions.
        """
        if self.segmentation is None:
            raise ValueError(f"{self.model} has no regions; take a segmentation")
        if "threshold" in self.metrics:
            return self.values, self.metrics["threshold"]
        return self.segmentation, 0.5
