"""How often null models reject where there is nothing."""

from typing import Annotated

from pydantic import Field

from surfexp.contract.metric import Metric
from surfexp.lab.registry.registry import register
from surfexp.mesh.surface import Surface
from surfexp.nulls.variogram import variogram_pairs
from surfexp.operators.surface_operator import SurfaceOperator
from surfexp.spectrum.eigensystem import EigenSystem
from surfexp.statistics.statistic import Statistic
from surfexp.studies.nulls.null_methods import OneSurface
from surfexp.studies.nulls.null_rejections import Design, null_rejections
from surfexp.variational.image import Image

METRICS = {
    "pairs": Metric("pairs of independent maps"),
    "rejections {method}": Metric("pairs of independent maps whose correlation is called significant at 5 %", "%"),
    "lowest {method}": Metric("lower end of the 95 % interval of their share", "%"),
    "highest {method}": Metric("upper end of the 95 % interval of their share", "%"),
    "exact_enough {method}": Metric("1 where that interval meets 4 to 6 %, else 0", better="higher"),
    "power {planted} {method}": Metric("pairs of maps with a planted correlation that are called significant", "%"),
    "power_error {method}": Metric("power in other groups of modes than the map's, over that of the map", "", "lower"),
    "variogram_error {method}": Metric("root mean square error of the variogram over its mean", "", "lower"),
    "values_error {method}": Metric("distance of the values from those of the map, in its deviations", "", "lower"),
}


@register("statistic", "null_rejections", metrics=METRICS, defaults_of=(variogram_pairs, OneSurface, Design))
def null_rejections_statistic(
    surface: Surface,
    sphere: Surface,
    operator: SurfaceOperator,
    eigensolver: EigenSystem,
    image: Image,
    *,
    maps: Annotated[
        int, Field(ge=2, le=10000, description="maps that get nulls; the other channels are their partners")
    ],
    nulls: Annotated[int, Field(ge=19, le=100000, description="nulls of each map")],
    planted: Annotated[tuple[float, ...], Field(min_length=1, description="planted correlations")],
    planted_partners: Annotated[
        int, Field(ge=1, le=10000, description="partners of each map with a planted correlation")
    ],
    examined: Annotated[
        int, Field(ge=1, le=10000, description="maps of whose nulls it is measured what they have kept")
    ],
    neighbours: Annotated[int, Field(ge=300, le=100000, description="vertices of the widest kernel, at most all")],
    reach: Annotated[float, Field(gt=0, description="largest distance of the variogram, unit of the surface")] = 50.0,
    vertices: Annotated[int, Field(ge=2, le=100000, description="vertices by which the variogram is estimated")],
    seed: Annotated[int, Field(ge=0, description="seed of the nulls")],
) -> Statistic:
    """Independent maps tested against each other with eigenstrapping, spins, variogram-matched nulls, permutation, Student's t."""
    pairs = variogram_pairs(surface.mesh, reach=reach, vertices=vertices, seed=seed)
    of = OneSurface(surface, sphere, operator, eigensolver, pairs, neighbours)
    return null_rejections(
        of,
        image.values,
        Design(
            maps=maps, nulls=nulls, planted=planted, planted_partners=planted_partners, examined=examined, seed=seed
        ),
    )
