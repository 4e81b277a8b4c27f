"""Maps of connectivity from parts of a run at rest."""

from typing import Annotated

import numpy as np
from pydantic import Field

from surfexp.anatomy.resting_run import connectivity_maps, run_on
from surfexp.lab.registry.registry import register
from surfexp.mesh.surface import Surface
from surfexp.skeleton.fast_marching import fast_marching
from surfexp.variational.image import Image


@register("image", "connectivity")
def connectivity_image(
    surface: Surface,
    *,
    radius: Annotated[float, Field(gt=0, le=100, description="radius of the patch along the surface, mm")] = 10.0,
    seed: Annotated[int, Field(ge=0, description="seed of the patch's centre")] = 0,
) -> Image:
    """Correlation with a patch of fsaverage5 in a run at rest: two parts measured, a third held out; needs brainspace."""
    series, confounds = run_on(surface)
    centre = int(np.random.default_rng(seed).integers(len(surface.mesh.vertices)))
    patch = fast_marching(surface.mesh, np.array([centre])) <= radius
    maps = connectivity_maps(series, confounds, patch)
    held_out = np.repeat(maps[:, 2:], 2, axis=1)
    return Image(maps[:, :2], "connectivity", "Fisher's z", clean=held_out)
