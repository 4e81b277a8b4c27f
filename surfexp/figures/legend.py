"""Names and flat colours of labels below a grid of pictures."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from surfexp.figures.labelling import legend_of
from surfexp.figures.panel_layout import LETTER, Layout
from surfexp.figures.render import SurfaceView
from surfexp.figures.typography import QUIET, points

# of a legend; where there are more labels their number is said instead
MOST_NAMES = 48
# in multiples of the text's size: height of a line, and width of a swatch with its gaps
LINE_BAND, SWATCH = 1.7, 3.0


def names_of(views: Sequence[SurfaceView]) -> list[tuple[str, Any]]:
    """Return name and colour of each label that the views show, none where they are too many to be told apart."""
    found = _found(views)
    return found if len(found) <= MOST_NAMES else []


def without_names(views: Sequence[SurfaceView]) -> tuple[str, ...]:
    """Say why a figure of labels has no legend; nothing where it has one, or no labels."""
    count = len(_found(views))
    return (
        (f"{count} labels are drawn without their names, a legend holds {MOST_NAMES}.",) if count > MOST_NAMES else ()
    )


def _found(views: Sequence[SurfaceView]) -> list[tuple[str, Any]]:
    return legend_of([view.labels for view in views if view.labels is not None])


def legend_columns(names: list[tuple[str, Any]], width: float, em: float) -> int:
    """Return how many names stand side by side."""
    longest = max((len(name) for name, _ in names), default=1)
    return max(min(int(0.96 * width / (em * (LETTER * longest + SWATCH))), len(names)), 1)


def legend_height(names: list[tuple[str, Any]], width: float, em: float) -> int:
    """Return the height of the legend in pixels, 0 without names."""
    return round(em * (LINE_BAND * -(-len(names) // legend_columns(names, width, em)) + 0.8)) if names else 0


def draw_legend(figure: Any, layout: Layout, names: list[tuple[str, Any]]) -> None:
    """Write the legend at the foot of a figure."""
    from matplotlib.patches import Patch

    if not names:
        return
    figure.legend(
        [Patch(facecolor=color, edgecolor=QUIET, linewidth=0.5) for _, color in names],
        [name for name, _ in names],
        loc="lower center",
        ncols=legend_columns(names, layout.width, layout.em),
        fontsize=points(0.92 * layout.em),
        frameon=False,
        borderpad=0.2,
        handlelength=1.2,
    )
