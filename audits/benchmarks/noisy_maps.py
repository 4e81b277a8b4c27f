"""The maps and the noises of the study of noise that is not white (docs/protocols/noise.md)."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np

from surfexp.anatomy.conte69 import conte69
from surfexp.anatomy.fsaverage5 import Hemisphere, fsaverage5
from surfexp.anatomy.subcortical import subcortical_surface
from surfexp.contract.arrays import Floats
from surfexp.mesh.masked_surface import cut_to_mask
from surfexp.mesh.shapes.icosphere import icosphere
from surfexp.mesh.shapes.torus import torus
from surfexp.mesh.surface import Surface
from surfexp.operators.fem import fem
from surfexp.operators.mean_curvature import mean_curvature
from surfexp.operators.surface_operator import SurfaceOperator
from surfexp.smoothing.methods import heat_time
from surfexp.variational.images import pictures
from surfexp.variational.images.painting import paint
from surfexp.variational.surface_flows import heat_flow

SEEDS = 5
NOISES = ("white", "outliers", "t3", "laplace", "varying", "smooth", "rounded", "none")
FIELD_WIDTH, NOISE_WIDTH = 12.0, 1.5


@dataclass(frozen=True, eq=False)
class NoisyMap:
    """A map without noise, of mean 0 and deviation 1 by area."""

    half: str
    name: str
    surface: Surface
    operator: SurfaceOperator
    values: Floats


def study_maps() -> Iterator[NoisyMap]:
    """Yield the six maps that fix the thresholds, then the six that judge."""
    ball, ring = icosphere(4), torus(n_u=80, n_v=32)
    yield standardised("first", "sphere, smooth field", ball, smooth_field(ball, 1))
    yield standardised("first", "sphere, parcels", ball, parcels(ball, 2))
    ramp = ball.mesh.vertices[:, 1]
    yield standardised("first", "sphere, ramps with borders", ball, parcels(ball, 3) + 2.0 * ramp / np.ptp(ramp))
    front = half_cortex("right", 1.0)
    for name in ("thickness", "sulc"):
        yield standardised("first", f"cortex, front, {name}", front, front.scalars[name])
    yield standardised("first", "torus, smooth field", ring, smooth_field(ring, 4))
    hippocampus = subcortical_surface(donor="9861", structure="hippocampus", hemisphere="left", vertices=2500)
    yield standardised("second", "hippocampus, smooth field", hippocampus, smooth_field(hippocampus, 5))
    yield standardised("second", "hippocampus, parcels", hippocampus, parcels(hippocampus, 6))
    back = half_cortex("left", -1.0)
    for name in ("thickness", "sulc"):
        yield standardised("second", f"cortex, back, {name}", back, back.scalars[name])
    yield standardised("second", "cortex, back, mean curvature", back, mean_curvature(back.mesh))
    picture = paint(ball, pictures.picture("cameraman"), "spherical", name="cameraman").values
    yield standardised("second", "sphere, cameraman", ball, picture)


def rough_maps() -> Iterator[NoisyMap]:
    """Yield maps that are rough themselves, on which thresholds were fixed too: mean curvature and painted pictures."""
    front, ball = half_cortex("right", 1.0), icosphere(4)
    yield standardised("first", "cortex, front, mean curvature", front, mean_curvature(front.mesh))
    for name in ("coins", "moon", "page"):
        picture = paint(ball, pictures.picture(name), "spherical", name=name).values
        yield standardised("first", f"sphere, {name}", ball, picture)


def conte69_maps() -> Iterator[NoisyMap]:
    """Yield three maps of the left side of conte69, 29,300 vertices, on which nothing was fixed; needs brainspace."""
    surface = conte69()
    for name in ("thickness", "t1wt2w", "fc_gradient0"):
        yield standardised("conte69", f"conte69, {name}", surface, surface.scalars[name])


def standardised(half: str, name: str, surface: Surface, values: Floats) -> NoisyMap:
    """Return a map with mean 0 and deviation 1 by area."""
    operator = fem(surface.mesh)
    share = operator.mass / operator.mass.sum()
    values = values - share @ values
    return NoisyMap(half, name, surface, operator, values / np.sqrt(share @ values**2))


def half_cortex(hemisphere: Hemisphere, side: float) -> Surface:
    """Return the front (1) or the back (-1) of a white surface of fsaverage5 without its medial wall."""
    surface = fsaverage5(hemisphere, "white")
    along = side * surface.mesh.vertices[:, 1]
    return cut_to_mask(surface, (surface.scalars["thickness"] > 0) & (along > np.median(along)))


def smooth_field(surface: Surface, seed: int, width: float = FIELD_WIDTH) -> Floats:
    """Return white noise after heat flow with a full width in edges."""
    operator = fem(surface.mesh)
    white = np.random.default_rng(seed).standard_normal(operator.vertex_count)
    return heat_flow(operator, white, heat_time(width * operator.edge_length))


def parcels(surface: Surface, seed: int) -> Floats:
    """Return the nearest of 14 points, as 0, 1 and 2 in turn."""
    vertices = surface.mesh.vertices
    centres = vertices[np.random.default_rng(seed).choice(len(vertices), 14, replace=False)]
    nearest = np.argmin(((vertices[:, None] - centres) ** 2).sum(axis=2), axis=1)
    return (nearest % 3).astype(np.float64)


def with_noise(clean: NoisyMap, noise: str, seed: int) -> Floats:
    """Return a map with one of the noises."""
    rng = np.random.default_rng([seed, NOISES.index(noise)])
    count = len(clean.values)
    white = rng.standard_normal(count)
    along = clean.surface.mesh.vertices[:, 1]
    growth = 5.0 ** ((along - along.min()) / np.ptp(along))

    def smooth() -> Floats:
        flowed = heat_flow(clean.operator, white, heat_time(NOISE_WIDTH * clean.operator.edge_length))
        return flowed / flowed.std()

    drawn: dict[str, Callable[[], Floats]] = {
        "white": lambda: 0.5 * white,
        "outliers": lambda: 0.3 * white + 6.0 * (rng.random(count) < 0.02) * rng.choice([-1.0, 1.0], count),
        "t3": lambda: 0.5 * rng.standard_t(3, count) / np.sqrt(3.0),
        "laplace": lambda: 0.5 * rng.laplace(size=count) / np.sqrt(2.0),
        "varying": lambda: 0.5 * growth / np.sqrt((growth**2).mean()) * white,
        "smooth": lambda: 0.5 * smooth(),
        "rounded": lambda: np.round((clean.values + 0.2 * white) / 0.5) * 0.5 - clean.values,
        "none": lambda: np.zeros(count),
    }
    return clean.values + drawn[noise]()
