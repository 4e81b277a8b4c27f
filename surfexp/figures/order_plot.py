"""Order of convergence: errors against mesh size, with the slopes that were measured."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from surfexp.contract.arrays import Floats
from surfexp.figures.axes import Label, add_axes, label_lines, logarithmic, style
from surfexp.figures.figure import Figure
from surfexp.figures.typography import canvas, drawn, vector
from surfexp.linalg.convergence_order import convergence_order


def order_plot(
    mesh_sizes: Floats,
    errors: Mapping[str, Floats],
    *,
    x_label: str = "mesh size h",
    y_label: str = "error",
    title: str = "",
    caption: str = "",
    size: tuple[int, int] = (1000, 620),
) -> Figure:
    """Errors under refinement on doubly logarithmic axes, finer to the right, with the measured order in each label.

    Parameters
    ----------
    mesh_sizes : (k,) float64
        Positive, at least two.
    errors : mapping of label to (k,) float64
        Positive.

    Returns
    -------
    Figure
        `metrics` holds "order <label>" for each line.

    Raises
    ------
    ValueError
        If there is nothing to draw, or a value is not positive.
    """
    if not errors:
        raise ValueError("order plot has 0 lines, at least 1 is needed")
    orders = {name: convergence_order(mesh_sizes, error) for name, error in errors.items()}
    finest = int(np.argmin(mesh_sizes))
    with canvas(*size) as figure:
        axes = add_axes(figure, title, x_label, y_label)
        labels: list[Label] = []
        for k, (name, error) in enumerate(errors.items()):
            axes.plot(mesh_sizes, error, **style(k))
            end = float(mesh_sizes[finest]), float(error[finest])
            labels.append((f"{name}, order {orders[name]:.2f}", *end, style(k)["color"]))
        logarithmic(axes)
        axes.invert_xaxis()
        label_lines(axes, labels)
        pixels, svg = drawn(figure), vector(figure)
    return Figure(pixels, caption, title, {f"order {name}": order for name, order in orders.items()}, svg=svg)
