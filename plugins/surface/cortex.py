"""Cortex-like surfaces for table 2.2."""

from typing import Literal

from pydantic import Field

from surfexp.lab.registry.registry import Options, register
from surfexp.mesh.shapes.cortex import cortex
from surfexp.mesh.surface import Surface


class Cortex(Options):
    """Which cortex, and its number of vertices."""

    form: Literal["smooth", "folded"] = Field("folded", description="smooth stands for M1, folded for M2")
    count: int = Field(39994, ge=10000, le=400000, description="number of vertices")
    seed: int = Field(0, ge=0, description="another field of sulci")


@register("surface", "cortex")
def cortex_surface(options: Cortex) -> Surface:
    """Synthetic cortex-like surface, closed, genus 0: smooth (M1) or with deep narrow sulci (M2)."""
    return cortex(**dict(options))
