"""The part of a surface where one of its maps is large enough."""

from pydantic import Field

from surfexp.lab.registry.registry import Options, register
from surfexp.mesh.masked_surface import cut_to_mask
from surfexp.mesh.surface import Surface


class MaskedByMap(Options):
    """Which map, and where it is cut."""

    map: str = Field("thickness", min_length=1, description="map of the original")
    above: float = Field(0.0, ge=-1e9, le=1e9, description="vertices stay where the map is larger")


@register("surface", "masked_by_map")
def masked_by_map_surface(options: MaskedByMap, *, original: Surface) -> Surface:
    """Another surface cut to where one of its maps exceeds a value, with a boundary there."""
    if options.map not in original.scalars:
        known = ", ".join(original.scalars) or "none"
        raise ValueError(f"no map {options.map!r} on {original.name}, choose of {known}")
    return cut_to_mask(original, original.scalars[options.map] > options.above)
