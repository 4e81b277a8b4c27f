"""Surfaces and what lives on their vertices, for viewers and for neuroimaging: .vtp, and GIFTI in single precision."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from surfexp.commands.exporting.names import slug
from surfexp.commands.exporting.writers import Place, arrays_of, maps_of, write, write_arrays, write_csv
from surfexp.contract.arrays import Floats, Integers
from surfexp.io.gifti import write_gifti, write_gifti_labels
from surfexp.io.label_files import label_colors
from surfexp.io.map_names import printable_name
from surfexp.io.map_shapes import scalar_channels
from surfexp.io.single_precision import check_single_precision_points
from surfexp.io.writing import write_mesh
from surfexp.io.written_maps import write_maps
from surfexp.mesh.surface import Surface
from surfexp.skeleton.feature import Feature
from surfexp.variational.image import Image
from surfexp.variational.solution import Solution


@write.register
def _surface(surface: Surface, place: Place) -> None:
    """The mesh with all maps as .vtp, and as .surf.gii where it is half of a brain; parcellations as .label.gii."""
    own: dict[str, Floats] = dict(surface.scalars)
    if surface.mask is not None:
        own["mask"] = surface.mask.astype(np.float64)
    if surface.truth.labels is not None:
        own["true labels"] = surface.truth.labels.astype(np.float64)
    if surface.part is not None and not surface.part.is_whole:
        own["vertex of the whole"] = surface.part.vertices.astype(np.float64)
    parcellations = {name: table.keys.astype(np.float64) for name, table in surface.labels.items()}
    maps = {printable_name(name): values for name, values in {**parcellations, **own, **place.carried}.items()}
    write_mesh(place.file(".vtp"), surface.mesh, maps)
    if surface.hemisphere:
        check_single_precision_points(surface.mesh.vertices, surface.mesh.faces)
        write_gifti(place.file(".surf.gii"), surface.mesh, surface.hemisphere, surface.frame)
    for name, table in surface.labels.items():
        _write_labels(place, name, table.keys, table.names, surface.hemisphere)


@write.register(Image)
@write.register(Feature)
def _map(result: Image | Feature, place: Place) -> None:
    """The maps as .shape.gii; reference segmentations of an image as .label.gii."""
    _write_maps(place, maps_of(result), result.name)
    for name, inside in getattr(result, "labels", {}).items():
        _write_labels(place, name, inside.astype(np.int64), {0: f"not {name}", 1: name}, _side(place))


@write.register
def _solution(solution: Solution, place: Place) -> None:
    """The minimiser as .shape.gii, regions as .label.gii, what was evaluated on the way as .csv, and all exactly as .npz."""
    write_arrays(place.file(".npz"), {name: array for name, array in arrays_of(solution).items() if "." not in name})
    _write_maps(place, {"": solution.values}, solution.model or "solution")
    if solution.segmentation is not None:
        keys = solution.segmentation.astype(np.int64)
        _write_labels(place, "segmentation", keys, {int(key): f"region {key}" for key in np.unique(keys)}, _side(place))
    if solution.history:
        write_csv(place.file("-history.csv"), list(solution.history), zip(*solution.history.values(), strict=True))


@maps_of.register
def _maps_of_image(image: Image) -> dict[str, Floats]:
    maps = {"": image.values}
    if image.clean is not None:
        maps["clean"] = image.clean
    if image.known is not None:
        maps["known"] = image.known.astype(np.float64)
    return maps


@maps_of.register
def _maps_of_feature(feature: Feature) -> dict[str, Floats]:
    return {"": feature.values}


@maps_of.register
def _maps_of_solution(solution: Solution) -> dict[str, Floats]:
    regions = {} if solution.segmentation is None else {"segmentation": solution.segmentation}
    return {"": solution.values, **regions}


def _write_maps(place: Place, maps: Mapping[str, Floats], name: str) -> None:
    """Write maps as one .shape.gii, and where the surface was cut out of another, as one more for the whole of that."""
    named = scalar_channels({printable_name(f"{name} {part}"): values for part, values in maps.items()})
    surface = place.surface
    write_maps(place.file(".shape.gii"), named, _side(place))
    if surface is not None and surface.part is not None and not surface.part.is_whole:
        whole = {key: surface.part.extend(values) for key, values in named.items()}
        write_maps(place.file("-whole.shape.gii"), whole, surface.hemisphere)


def _side(place: Place) -> str:
    """The hemisphere that a result on a surface belongs to."""
    return place.surface.hemisphere if place.surface is not None else ""


def _write_labels(place: Place, name: str, keys: Integers, names: Mapping[Any, str], hemisphere: str) -> None:
    """Write labels with a name for every key that occurs; keys that were stored have become text."""
    named = {int(key): label for key, label in names.items()}
    table = {**{int(key): f"no label {key}" for key in np.unique(keys)}, **named}
    path = place.file(f"-{slug(name, 40) or 'labels'}.label.gii")
    write_gifti_labels(path, keys, dict(sorted(table.items())), label_colors(len(table)), hemisphere)
