"""An image with lost parts."""

from dataclasses import replace
from typing import Annotated

import numpy as np
from pydantic import Field

from surfexp.contract.metric import Metric
from surfexp.lab.registry.registry import register
from surfexp.mesh.surface import Surface
from surfexp.variational.image import Image

METRICS = {
    "lost_share": Metric("share of the area that is lost"),
}


@register("image", "inpainting_domain", metrics=METRICS)
def inpainting_domain_image(
    surface: Surface,
    original: Image,
    *,
    discs: Annotated[
        int, Field(ge=1, le=10000, description="number of lost discs, balls in space about random vertices")
    ] = 40,
    radius: Annotated[float, Field(gt=0, description="radius of a disc in edge lengths")] = 3.0,
    share: Annotated[float, Field(ge=0, lt=1, description="share of single vertices that are lost besides")] = 0.0,
    seed: Annotated[int, Field(ge=0, description="seed of the lost places")] = 0,
) -> Image:
    """Another image with discs and single vertices lost; `known` says where it was kept."""
    random = np.random.default_rng(seed)
    vertices = surface.mesh.vertices
    lost = random.random(len(vertices)) < share
    for centre in vertices[random.choice(len(vertices), min(discs, len(vertices)), replace=False)]:
        lost |= ((vertices - centre) ** 2).sum(axis=1) < (radius * surface.mesh.edge_length) ** 2
    known = ~lost
    clean = original.values if original.clean is None else original.clean
    metrics = {"lost_share": float(surface.mesh.vertex_areas @ lost / surface.mesh.area)}
    mean = float(original.values[known].mean()) if known.any() else 0.0
    observed = np.where(known, original.values, mean)
    note = f"{100 * metrics['lost_share']:.3g} % of the area is lost"
    notes = (*original.notes, note)
    return replace(original, values=observed, clean=clean, known=known, metrics=metrics, notes=notes)
