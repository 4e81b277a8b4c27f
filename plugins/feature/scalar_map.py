"""A map that came with the surface as a feature."""

from typing import Annotated

from pydantic import Field

from surfexp.lab.registry.registry import register
from surfexp.mesh.surface import Surface
from surfexp.skeleton.feature import Feature


@register("feature", "scalar_map")
def scalar_map_feature(
    surface: Surface, *, map: Annotated[str, Field(description="name of the scalar map; default: the only one")] = ""
) -> Feature:
    """A scalar map of the surface, read from its file or made with it, sulcal depth for instance."""
    known = tuple(surface.scalars)
    name = map or (known[0] if len(known) == 1 else "")
    if name not in known:
        chosen = f"map {name!r}" if name else "single map"
        raise ValueError(f"surface {surface.name!r} has no {chosen}, its maps are: {', '.join(known) or 'none'}")
    return Feature(surface.scalars[name], name)
