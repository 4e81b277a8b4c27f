"""The part of a surface where one of its maps is large enough."""

from typing import Annotated

from pydantic import Field

from surfexp.lab.registry.registry import register
from surfexp.mesh.masked_surface import cut_to_mask
from surfexp.mesh.surface import Surface


@register("surface", "masked_by_map")
def masked_by_map_surface(
    original: Surface,
    *,
    map: Annotated[str, Field(min_length=1, description="map of the original")] = "thickness",
    above: Annotated[
        float, Field(ge=-1000000000.0, le=1000000000.0, description="vertices stay where the map is larger")
    ] = 0.0,
) -> Surface:
    """Another surface cut to where one of its maps exceeds a value, with a boundary there."""
    if map not in original.scalars:
        known = ", ".join(original.scalars) or "none"
        raise ValueError(f"no map {map!r} on {original.name}, choose of {known}")
    return cut_to_mask(original, original.scalars[map] > above)
