"""Gap against iterations for every solver of an axis."""

from pydantic import Field

from surfexp.figures.convergence_plot import convergence_plot
from surfexp.figures.figure import Figure
from surfexp.lab.registry.registry import Options, register
from surfexp.variational.solution import Solution


class Convergence(Options):
    """What is drawn against the iterations."""

    quantity: str = Field("gap", description="history that is drawn: gap, energy or change")
    rates: list[float] = Field([], description="orders of the dashed lines for comparison")
    caption: str = Field("", description="sentence below the figure")


@register("figure", "convergence")
def convergence_figure(options: Convergence, *, solvers: dict[str, Solution]) -> Figure:
    """Histories of the solvers of an axis, doubly logarithmic; a solver without this history is left out."""
    histories = {
        label: (solution.history["iteration"], solution.history[options.quantity])
        for label, solution in solvers.items()
        if options.quantity in solution.history
    }
    label = {"gap": "relative gap", "change": "relative change"}.get(options.quantity, options.quantity)
    return convergence_plot(histories, y_label=label, rates=options.rates, title="Convergence", caption=options.caption)
