"""The ways in which the eigensolvers refuse."""

from __future__ import annotations


class EigensolverError(ValueError):
    """A pencil or a request for which no certified pairs can be given; the message names the cause and the way out."""


class SliverError(EigensolverError):
    """Pairs that rounding leaves in doubt, as faces of nearly no area do; the intrinsic Delaunay triangles have none."""
