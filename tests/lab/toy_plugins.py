"""Toy plugins for the stage contract: a kind that recurs along a chain, two inputs of one kind, a list over an axis."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Annotated

import numpy as np
from pydantic import Field

from surfexp.contract.member import Member
from surfexp.contract.metric import Metric
from surfexp.lab.registry.registry import register
from surfexp.lab.store.kinds import stage_kind
from surfexp.mesh.surface import Surface
from surfexp.mesh.triangle_mesh import TriangleMesh
from surfexp.variational.solution import Solution


@dataclass(frozen=True, eq=False)
class Feature:
    values: np.ndarray
    trace: str = ""
    metrics: dict[str, float] = field(default_factory=dict)


@dataclass(frozen=True, eq=False)
class Weighted:
    values: np.ndarray
    trace: str = ""


@dataclass(frozen=True, eq=False)
class Pairing:
    value: float
    trace: str = ""
    metrics: dict[str, float] = field(default_factory=dict)


stage_kind("scalar", Feature)
stage_kind("weighted", Weighted)
stage_kind("pairing", Pairing)


@register("surface", "toy_doubled")
def toy_doubled(
    original: Surface, *, turned: Annotated[float | None, Field(description="not looked at")] = None
) -> Surface:
    """Another surface, with an option that may be absent."""
    return original


@register("surface", "toy_triangle")
def toy_triangle(*, size: Annotated[float, Field(gt=0, description="side length")] = 1.0) -> Surface:
    """One right triangle."""
    vertices = size * np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0]])
    return Surface(TriangleMesh(vertices, np.array([[0, 1, 2]])), metrics={"area": 0.5 * size**2})


@register("scalar", "toy_boundary")
def toy_boundary(
    surface: Surface, *, shift: Annotated[float, Field(description="added to every value")] = 0.0
) -> Feature:
    """A feature of the surface alone."""
    return Feature(surface.mesh.vertices[:, 0] + shift, "boundary")


@register("weighted", "toy_flux")
def toy_flux(surface: Surface, weight: Feature) -> Weighted:
    """An operator that needs a feature."""
    return Weighted(weight.values + surface.mesh.area, f"flux({weight.trace})")


@register("scalar", "toy_eigenfunction")
def toy_eigenfunction(weighted: Weighted) -> Feature:
    """A feature made from an operator that was made from a feature."""
    return Feature(2.0 * weighted.values, f"eigen({weighted.trace})")


@register("pairing", "toy_distance")
def toy_distance(source: Feature, target: Feature) -> Pairing:
    """Two inputs of one kind."""
    value = float(np.abs(source.values - target.values).max())
    return Pairing(value, f"{source.trace}~{target.trace}", metrics={"distance": value})


@register("pairing", "toy_spread")
def toy_spread(features: list[Feature], named: dict[str, Feature]) -> Pairing:
    """Lists that fan in over an axis."""
    value = float(np.ptp([item.values.sum() for item in features]))
    return Pairing(value, ",".join(named), metrics={"spread": value})


@register("pairing", "toy_members")
def toy_members(features: dict[Member, Feature]) -> Pairing:
    """What is known of the members of an axis."""
    facts = [f"{member.class_name}/{member.group}/{member.level}" for member in features]
    return Pairing(float(len(features)), ",".join(facts))


@register("pairing", "toy_failure")
def toy_failure(surface: Surface) -> Pairing:
    """A stage that fails."""
    raise ValueError(f"surface has area {surface.mesh.area}, at least 1e9 is needed")


@register("solver", "toy_loose")
def toy_loose(
    surface: Surface,
    *,
    gap: Annotated[float | None, Field(description="relative gap that it claims; null is no number")] = 1.45,
    converged: Annotated[bool, Field(description="whether it claims to have converged")] = True,
    tolerance: Annotated[float | None, Field(description="bound of its gap")] = None,
) -> Solution:
    """A solver whose certificate is what it is told."""
    return Solution(np.zeros(3), 1.0, converged=converged, metrics={"relative_gap": np.nan if gap is None else gap})


@register("pairing", "toy_judge", metrics={"energy": Metric("energy of the solution")})
def toy_judge(solution: Solution) -> Pairing:
    """What becomes of a solution."""
    return Pairing(solution.energy, metrics={"energy": solution.energy})
