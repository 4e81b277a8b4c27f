"""Isospectral drums, section 4.2 and figure 4.1."""

from typing import Annotated, Literal

import numpy as np
from pydantic import Field

from surfexp.contract.metric import Metric
from surfexp.lab.registry.registry import register
from surfexp.mesh.shapes.isospectral_drum import GORDON_WEBB_WOLPERT, TILE_SHAPES
from surfexp.statistics.statistic import Statistic
from surfexp_studies.drums.drum_elements import GORDON_WEBB_WOLPERT_VALUES
from surfexp_studies.drums.isospectral_comparison import compare_drums
from surfexp_studies.drums.isospectral_graphs import compare_graphs
from surfexp_studies.drums.transplantation_pairs import transplantation_pairs

NAMED = {"gordon_webb_wolpert": "Gordon-Webb-Wolpert drums", "berard": "drums of Berard's transplantation"}


ISOSPECTRAL_DRUMS_METRICS = {
    "spectral_difference": Metric("largest relative difference of the two spectra", better="lower"),
    "complete": Metric("1 where it is proved of both that no eigenvalue is missing, else 0", better="higher"),
    "transplanted": Metric("largest error of a transplanted eigenfunction", better="lower"),
    "first_differing_mode": Metric("first mode with different nodal counts, 0 where there is none"),
    "differing_modes": Metric("modes with different nodal counts"),
    "congruent": Metric("1 where the two outlines are congruent, else 0"),
    "degrees_of_freedom": Metric("unknowns of the discrete problem"),
    "error_to_published": Metric("largest relative error to the published values", better="lower"),
}


@register("statistic", "isospectral_drums", metrics=ISOSPECTRAL_DRUMS_METRICS, defaults_of=compare_drums)
def isospectral_drums(
    *,
    pair: Annotated[
        Literal["gordon_webb_wolpert", "berard", "0", "1", "2", "3", "4", "5", "6"],
        Field(description="by name (berard: the same gluing, for any tile), or the number of one of the seven pairs"),
    ] = "gordon_webb_wolpert",
    tile: Annotated[
        Literal["right_isosceles", "scalene", "obtuse"], Field(description="shape of the tile")
    ] = "right_isosceles",
    divisions: Annotated[int, Field(ge=2, le=100, description="divisions of a side of the tile")],
    grading: Annotated[float, Field(ge=1, le=6, description="exponent that draws nodes to the corners; 1: uniform")],
    order: Annotated[Literal[1, 2, 3], Field(description="order of the elements")],
    count: Annotated[int, Field(ge=2, le=500, description="eigenvalues")],
    boundary: Annotated[Literal["dirichlet", "neumann"], Field(description="condition on the boundary")],
) -> Statistic:
    """Spectra and nodal counts of two drums of seven equal tiles that sound the same."""
    named = pair in NAMED
    drums = GORDON_WEBB_WOLPERT if named else transplantation_pairs()[int(pair)]
    found = compare_drums(
        drums,
        TILE_SHAPES[tile],
        divisions,
        count,
        order,
        grading,
        boundary,
    )
    differing = found.differing_modes
    metrics = {
        "spectral_difference": found.spectral_difference,
        "complete": float(found.first.complete and found.second.complete),
        "transplanted": found.transplanted,
        "first_differing_mode": float(differing[0]) if len(differing) else 0.0,
        "differing_modes": float(len(differing)),
        "congruent": float(found.outline_difference < 1e-6),
        "degrees_of_freedom": float(len(found.first.vectors)),
    }
    if named and tile == "right_isosceles" and boundary == "dirichlet":
        known = np.array(GORDON_WEBB_WOLPERT_VALUES)[:count]
        metrics["error_to_published"] = float(np.abs(found.first.values[: len(known)] / known - 1.0).max())
    columns = {
        "mode": np.arange(1.0, count + 1.0),
        "first spectrum": found.first.values,
        "second spectrum": found.second.values,
        "first counts": found.first_counts.astype(np.float64),
        "second counts": found.second_counts.astype(np.float64),
    }
    name = NAMED.get(pair, f"drums of pair {pair}")
    return Statistic(f"{name}, {tile.replace('_', ' ')} tile", columns, metrics=metrics)


ISOSPECTRAL_GRAPHS_METRICS = {
    "graphs": Metric("number of graphs"),
    "vertices": Metric("vertices of the largest graph"),
    "adjacency_difference": Metric("largest difference of adjacency spectra", better="lower"),
    "laplacian_difference": Metric("largest difference of Laplacian spectra", better="lower"),
    "isomorphic": Metric("pairs that are the same graph"),
}


@register("statistic", "isospectral_graphs", metrics=ISOSPECTRAL_GRAPHS_METRICS)
def isospectral_graphs() -> Statistic:
    """Graphs glued as the drums are: equal spectra of adjacency and Laplacian, and whether they are the same graph."""
    found = [compare_graphs(pair) for pair in transplantation_pairs()]
    columns = {
        "vertices": np.array([float(graph.vertices) for graph in found]),
        "adjacency difference": np.array([graph.adjacency_difference for graph in found]),
        "Laplacian difference": np.array([graph.laplacian_difference for graph in found]),
        "isomorphic": np.array([float(graph.isomorphic) for graph in found]),
    }
    metrics = {
        "graphs": float(2 * len(found)),
        "vertices": columns["vertices"].max(),
        "adjacency_difference": columns["adjacency difference"].max(),
        "laplacian_difference": columns["Laplacian difference"].max(),
        "isomorphic": columns["isomorphic"].sum(),
    }
    rows = tuple(f"pair {number}" for number in range(len(found)))
    return Statistic("isospectral graphs", columns, rows, {name: float(value) for name, value in metrics.items()})
