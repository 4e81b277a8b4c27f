"""Cortex-like surfaces for table 2.2."""

from typing import Annotated, Literal

from pydantic import Field

from surfexp.lab.registry.registry import register
from surfexp.mesh.shapes.cortex import cortex
from surfexp.mesh.surface import Surface


@register("surface", "cortex", defaults_of=cortex)
def cortex_surface(
    *,
    form: Annotated[Literal["smooth", "folded"], Field(description="smooth stands for M1, folded for M2")],
    count: Annotated[int, Field(ge=10000, le=400000, description="number of vertices")],
    seed: Annotated[int, Field(ge=0, description="another field of sulci")],
) -> Surface:
    """Synthetic cortex-like surface, closed, genus 0: smooth (M1) or with deep narrow sulci (M2)."""
    return cortex(form=form, count=count, seed=seed)
