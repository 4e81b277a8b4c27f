"""A coloured texture."""

from pydantic import Field

from surfexp.lab.registry.registry import Options, register
from surfexp.mesh.surface import Surface
from surfexp.variational.image import Image
from surfexp.variational.images.painting import add_noise
from surfexp.variational.images.two_phase import coloured_cells


class ColouredCells(Options):
    """The cells and the noise."""

    cells: int = Field(24, ge=2, le=1000, description="number of cells")
    cells_seed: int = Field(0, ge=0, description="seed of places and colours of the cells")
    noise: float = Field(0.0, ge=0, description="standard deviation of the Gaussian noise, of 0..255")
    seed: int = Field(0, ge=0, description="seed of the noise")


@register("image", "coloured_cells")
def coloured_cells_image(options: ColouredCells, *, surface: Surface) -> Image:
    """Cells of one random colour each, three channels of 0..255, with seeded noise."""
    return add_noise(coloured_cells(surface, options.cells, options.cells_seed), options.noise, options.seed)
