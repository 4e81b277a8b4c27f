"""What a picture of a result shows: rows of maps with their colours and lines."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from surfexp.contract.arrays import Floats
from surfexp.contract.drawable import Drawable
from surfexp.embedding.distance import Distance
from surfexp.mesh.surface import Surface
from surfexp.skeleton.skeleton import Skeleton
from surfexp.spectrum.eigensystem import EigenSystem
from surfexp.tasks.comparison_of_maps import MapComparison
from surfexp.tasks.denoised_map import DenoisedMap
from surfexp.tasks.denoising_path import DenoisingPath
from surfexp.tasks.map_colours import CENTRAL, DIVERGING, central_ends
from surfexp.tasks.map_row import MapRow
from surfexp.tasks.mode_alignment import ModeAlignment
from surfexp.tasks.mode_numbers import mode_numbers
from surfexp.tasks.null_maps import NullMaps
from surfexp.tasks.parcel_table import Parcels
from surfexp.tasks.tested_maps import PermutationTest
from surfexp.variational.fitted_noise import FittedNoise

# eigenfunctions and null maps that a picture shows
MODES, NULLS = 6, 4
# of the weight of least risk, those at which a path is shown
STILLS = (0.2, 1.0, 5.0)
# of eigenfunctions in units of their root mean square; of a map and what was taken from it
MODE_LIMITS = (-2.0, 2.0)
MODE_BAR = "eigenfunction, units of its root mean square"


def rows_of_result(result: Drawable, surfaces: Sequence[Surface]) -> list[MapRow]:
    """Return the rows of a picture of a result.

    Raises
    ------
    ValueError
        If it belongs to another number of surfaces.
    """
    if isinstance(result, Distance):
        return [_correspondence(result, surfaces)]
    if len(surfaces) != 1:
        raise ValueError(f"a {type(result).__name__} belongs to 1 surface, {len(surfaces)} are given: give its own")
    return _of_result(result, surfaces[0])


def _of_result(result: Drawable, surface: Surface) -> list[MapRow]:
    if isinstance(result, Skeleton):
        return [MapRow("", [None], skeleton=result)]
    if isinstance(result, FittedNoise):
        return [MapRow("level of the noise", [result.levels])]
    if isinstance(result, MapComparison):
        return _of_result(result.surrogates, surface)
    if isinstance(result, NullMaps):
        count = result.values.shape[1]
        return [MapRow(f"null map {k} of {count}", [one]) for k, one in enumerate(result.values.T[:NULLS], 1)]
    if isinstance(result, PermutationTest):
        return _tested(result)
    if isinstance(result, Parcels) and result.means.ndim > 1:
        titles = result.channels or [f"map {k}" for k in range(1, NULLS + 1)]
        return [MapRow(title, [one]) for title, one in zip(titles, result.values.T[:NULLS], strict=False)]
    if isinstance(result, DenoisingPath):
        return _along(result)
    if isinstance(result, DenoisedMap):
        return _before_and_after(result)
    if isinstance(result, ModeAlignment):
        aligned = zip(mode_numbers(result), result.vectors.T[:MODES], strict=False)
        return [_mode(f"aligned mode {k}", one) for k, one in aligned]
    if not isinstance(result, EigenSystem):
        return [MapRow("", [result])]
    n, numbers = len(surface.mesh.vertices), mode_numbers(result)
    first = int((result.values < 1e-9 * result.values[-1]).sum()) if len(result.values) > 1 else 0
    shown = range(first, min(len(result.values), first + MODES)) or range(1)
    names = (f"mode {numbers[k]}, λ = {result.values[k]:.4g}" for k in shown)
    return [_mode(name, result.vectors[:n, k]) for name, k in zip(names, shown, strict=True)]


def _mode(name: str, values: Floats) -> MapRow:
    """An eigenfunction in units of its root mean square, with its nodal lines."""
    scale = float(np.sqrt(np.nanmean(values**2))) or 1.0
    return MapRow(name, [values / scale], MODE_LIMITS, DIVERGING, (0.0,), bar=MODE_BAR)


def _tested(result: PermutationTest) -> list[MapRow]:
    """t, and the corrected p of its enhancement with a line where it is the level."""
    most = float(np.nanmax(np.abs(result.t))) or 1.0
    least = 1.0 / len(result.null["tfce"])
    line = -float(np.log10(result.level))
    limits = (0.0, max(-float(np.log10(least)), line))
    return [
        MapRow("t", [result.t], (-most, most), DIVERGING),
        MapRow("family-wise p of TFCE", [-np.log10(result.p_tfce)], limits, None, (line,), bar="-log10 p"),
    ]


def _before_and_after(result: DenoisedMap) -> list[MapRow]:
    """The map before, after, and what was taken away; the first two in the same colours."""
    before, method = result.given, str(result.certificate.get("chosen", result.method))
    if before is None or before.shape != result.values.shape or before.ndim > 1:
        return [MapRow(f"{result.name}, {method.replace('_', ' ')}", [result.values])]
    known = np.isfinite(result.values) & np.isfinite(before)
    limits = central_ends([before[known]])
    removed = np.where(known, before - result.values, np.nan)
    most = float(np.nanpercentile(np.abs(removed), CENTRAL[1])) if known.any() else 0.0
    apart = (-most, most) if most > 0.0 else None
    return [
        MapRow(f"{result.name} before", [np.where(known, before, np.nan)], limits, bar=result.name),
        MapRow(f"after {method.replace('_', ' ')}", [result.values], limits, bar=result.name),
        MapRow("removed", [removed], apart, DIVERGING, quantity=result.name),
    ]


def _along(path: DenoisingPath) -> list[MapRow]:
    """The map before, and after at the weight of least risk and at a fifth and five times it, in the same colours."""
    risk = path.risk()
    low, high = float(path.weights[0]), float(path.weights[-1])
    chosen = sorted({float(np.clip(factor * risk.weight, low, high)) for factor in STILLS})
    said = path.risk(chosen)
    maps = [path.at(weight).values for weight in chosen]
    limits = central_ends([maps[-1]])
    names = [f"weight {weight:.3g}, risk {value:.2g}" for weight, value in zip(chosen, said.risks, strict=True)]
    rows = [MapRow(name, [one], limits, bar=path.name) for name, one in zip(names, maps, strict=True)]
    return [*rows, MapRow("before", [path.given], limits, bar=path.name)]


def _correspondence(found: Distance, surfaces: Sequence[Surface]) -> MapRow:
    """Both surfaces in the same colours: those of the places of the source, carried to the target by the map."""
    sizes = [len(one.mesh.vertices) for one in surfaces]
    wanted = [len(found.source_points), len(found.correspondence)]
    if sizes != wanted:
        raise ValueError(
            f"surfaces have {sizes} vertices, the distance was found between {wanted}: give [source, target]"
        )
    places = surfaces[0].mesh.vertices
    low, high = np.nanmin(places, axis=0), np.nanmax(places, axis=0)
    colors = 0.15 + 0.8 * (places - low) / np.where(high > low, high - low, 1.0)
    rows = found.correspondence
    carried = np.where((rows >= 0)[:, None], colors[np.maximum(rows, 0)], np.nan)
    return MapRow("", [colors, carried])
