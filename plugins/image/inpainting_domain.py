"""An image with lost parts."""

from dataclasses import replace

import numpy as np
from pydantic import Field

from surfexp.contract.metric import Metric
from surfexp.lab.registry.registry import Options, register
from surfexp.mesh.surface import Surface
from surfexp.variational.image import Image


class InpaintingDomain(Options):
    """The discs and single vertices at which the image is lost."""

    discs: int = Field(40, ge=1, le=10000, description="number of lost discs, balls in space about random vertices")
    radius: float = Field(3.0, gt=0, description="radius of a disc in edge lengths")
    share: float = Field(0.0, ge=0, lt=1, description="share of single vertices that are lost besides")
    seed: int = Field(0, ge=0, description="seed of the lost places")


METRICS = {
    "lost_share": Metric("share of the area that is lost"),
}


@register("image", "inpainting_domain", metrics=METRICS)
def inpainting_domain_image(options: InpaintingDomain, *, surface: Surface, original: Image) -> Image:
    """Another image with discs and single vertices lost; `known` says where it was kept."""
    random = np.random.default_rng(options.seed)
    vertices = surface.mesh.vertices
    lost = random.random(len(vertices)) < options.share
    for centre in vertices[random.choice(len(vertices), min(options.discs, len(vertices)), replace=False)]:
        lost |= ((vertices - centre) ** 2).sum(axis=1) < (options.radius * surface.mesh.edge_length) ** 2
    known = ~lost
    clean = original.values if original.clean is None else original.clean
    metrics = {"lost_share": float(surface.mesh.vertex_areas @ lost / surface.mesh.area)}
    mean = float(original.values[known].mean()) if known.any() else 0.0
    observed = np.where(known, original.values, mean)
    note = f"{100 * metrics['lost_share']:.3g} % of the area is lost"
    notes = (*original.notes, note)
    return replace(original, values=observed, clean=clean, known=known, metrics=metrics, notes=notes)
