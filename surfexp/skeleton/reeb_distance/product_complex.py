"""Arcs and triangles inside the product of two graphs."""

from __future__ import annotations

from itertools import product

import numpy as np

from surfexp.skeleton.common_space import CommonSpace
from surfexp.skeleton.reeb_distance.located_parts import Location, Part

Point = tuple[Location, Location]


class Product:
    """What is filled of a product: no two arcs join the same pair, and the sides of triangles are arcs."""

    def __init__(self) -> None:
        self._points: dict[Point, int] = {}
        self._arcs: dict[frozenset[Point], None] = {}
        self._triangles: dict[frozenset[Point], None] = {}

    def join(self, *corners: Point) -> None:
        """Add a point, an arc or a triangle."""
        for corner in corners:
            self._points.setdefault(corner, len(self._points))
        if len(set(corners)) == len(corners) > 1:
            (self._arcs if len(corners) == 2 else self._triangles)[frozenset(corners)] = None

    def fill(self, ours: Part, theirs: Part) -> None:
        """Add the product of two parts."""
        for point in product(ours.locations, theirs.locations):
            self.join(point)
        for a, (s, t) in product(ours.locations, theirs.joined):
            self.join((a, s), (a, t))
        for (a, b), s in product(ours.joined, theirs.locations):
            self.join((a, s), (b, s))
        for (a, b), (s, t) in product(ours.joined, theirs.joined):
            self.join((a, s), (b, t))
            self.join((a, s), (b, s), (b, t))
            self.join((a, s), (a, t), (b, t))

    def with_heights(self, first: dict[Location, float], second: dict[Location, float]) -> CommonSpace:
        """Return it with the heights of both graphs at its points."""
        cells = [
            np.array([sorted(self._points[corner] for corner in cell) for cell in some], dtype=np.int64)
            for some in (self._arcs, self._triangles)
        ]
        return CommonSpace(
            np.array([first[a] for a, _ in self._points]),
            np.array([second[s] for _, s in self._points]),
            cells[0].reshape(-1, 2),
            cells[1].reshape(-1, 3),
        )
