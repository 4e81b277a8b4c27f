"""Gap against iterations for every solver of an axis."""

from collections.abc import Sequence
from typing import Annotated

from pydantic import Field

from surfexp.figures.convergence_plot import convergence_plot
from surfexp.figures.figure import Figure
from surfexp.lab.registry.registry import register
from surfexp.variational.solution import Solution


@register("figure", "convergence", defaults_of=convergence_plot)
def convergence_figure(
    solvers: dict[str, Solution],
    *,
    quantity: Annotated[str, Field(description="history that is drawn: gap, energy or change")] = "gap",
    rates: Annotated[Sequence[float], Field(description="orders of the dashed lines for comparison")],
    caption: Annotated[str, Field(description="sentence below the figure")],
) -> Figure:
    """Histories of the solvers of an axis, doubly logarithmic; a solver without this history is left out."""
    histories = {
        label: (solution.history["iteration"], solution.history[quantity])
        for label, solution in solvers.items()
        if quantity in solution.history
    }
    label = {"gap": "relative gap", "change": "relative change"}.get(quantity, quantity)
    return convergence_plot(histories, y_label=label, rates=rates, title="Convergence", caption=caption)
