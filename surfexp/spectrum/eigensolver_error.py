"""The one way in which the eigensolvers refuse."""

from __future__ import annotations


class EigensolverError(ValueError):
    """A pencil or a request for which no certified pairs can be given; the message names the cause and the way out."""
