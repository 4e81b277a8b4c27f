"""A coloured texture."""

from typing import Annotated

from pydantic import Field

from surfexp.lab.registry.registry import register
from surfexp.mesh.surface import Surface
from surfexp.variational.image import Image
from surfexp.variational.images.painting import add_noise
from surfexp.variational.images.two_phase import coloured_cells


@register("image", "coloured_cells", defaults_of=(add_noise, coloured_cells))
def coloured_cells_image(
    surface: Surface,
    *,
    cells: Annotated[int, Field(ge=2, le=1000, description="number of cells")],
    cells_seed: Annotated[int, Field(ge=0, description="seed of places and colours of the cells")] = 0,
    noise: Annotated[float, Field(ge=0, description="standard deviation of the Gaussian noise, of 0..255")] = 0.0,
    seed: Annotated[int, Field(ge=0, description="seed of the noise")],
) -> Image:
    """Cells of one random colour each, three channels of 0..255, with seeded noise."""
    return add_noise(coloured_cells(surface, cells, cells_seed), noise, seed)
