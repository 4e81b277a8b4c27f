"""The bytes of a page's surfaces: each array once, whatever number of scenes shows it, within a budget."""

from __future__ import annotations

import hashlib
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from surfexp.contract.arrays import Floats
from surfexp.figures.camera import VIEWS
from surfexp.figures.colormap import MISSING
from surfexp.figures.lines import Lines
from surfexp.figures.render import CLAY, CLAY_SHADING, VALUE_SHADING
from surfexp.mesh.triangle_mesh import TriangleMesh
from surfexp.viewer.quantised import LAST, Codes, exact_codes, packed, quantised
from surfexp.viewer.scene import Drawn, Field, Scene

# a page is to be 12 MB at most: this, the library (0.6 MB), and tables
BUDGET = 9_000_000
# steps of a colour scale that a code is to tell apart; labels that a code of 16 bits does
COLOR_STEPS, MOST_LABELS = 1000, LAST


@dataclass
class Payload:
    """The arrays of a page by their digests, as text, and what they may take together."""

    budget: int = BUDGET
    arrays: dict[str, str] = field(default_factory=dict)

    @property
    def size(self) -> int:
        """Bytes that the arrays take."""
        return sum(map(len, self.arrays.values()))

    def add(self, scene: Scene) -> dict[str, Any]:
        """Take the arrays of a scene; return its description, which refers to them.

        Raises
        ------
        ValueError
            If they do not fit any more; then none is taken.
        """
        taken = Payload(self.budget, dict(self.arrays))
        surfaces = [taken._surface(drawn) for drawn in scene.surfaces]
        if taken.size > self.budget:
            raise ValueError(
                f"{(taken.size - self.size) / 1e6:.1f} MB more would pass the {self.budget / 1e6:g} MB "
                "that surfaces may take of a page"
            )
        self.arrays = taken.arrays
        curve = {} if scene.curve is None else {"curve": scene.curve.described()}
        return {
            "surfaces": surfaces,
            "panels": [*map(list, scene.panels)],
            "titles": list(scene.titles),
            "eyes": [*map(list, scene.eyes)],
            "view": list(scene.view),
            "views": VIEWS,
            **curve,
        }

    def _surface(self, drawn: Drawn) -> dict[str, Any]:
        small = np.uint16 if len(drawn.mesh.vertices) <= LAST else np.uint32  # that number itself ends a strip
        return {
            "name": drawn.name,
            "outside": _shows_its_outside(drawn.mesh),
            "positions": self._numbers(drawn.mesh.vertices),
            "faces": self._codes(drawn.mesh.faces.astype(small)),
            **({} if drawn.origin is None else {"origin": self._codes(drawn.origin.astype(np.uint32)[:, None])}),
            "fields": [self._field(one) for one in drawn.fields],
            "sides": {name: list(direction) for name, direction in drawn.sides.items()},
        }

    def _field(self, one: Field) -> dict[str, Any]:
        numbers = [step.values for step in one.steps if step.values is not None]
        values = np.concatenate([np.empty(0), *numbers])
        scale = one.scale if one.labels is not None or not numbers else one.scale.fitted(values)
        limits = None if one.labels is not None else scale.limits
        steps = [
            {
                "name": step.name,
                "values": None if step.values is None else self._values(step.values, limits),
                "lines": [stroke for line in step.lines for stroke in self._strokes(line)],
            }
            for step in one.steps
        ]
        if one.labels is not None:
            if len(one.labels.names) > MOST_LABELS:
                raise ValueError(
                    f"{len(one.labels.names)} labels, a page tells {MOST_LABELS} apart: give the numbers as floats to see a map"
                )
            table, names = self._table(one.labels.colors), list(one.labels.names)
            found = {"name": one.name, "labels": names, "table": table, "shading": VALUE_SHADING, "steps": steps}
            return found if one.legend else {**found, "legend": False}
        if not numbers:
            return {"name": one.name, "table": self._table(np.array([CLAY])), "shading": CLAY_SHADING, "steps": steps}
        stops = {"stops": [{"place": stop.place, "name": stop.name} for stop in one.stops]} if one.stops else {}
        return {
            "name": one.name,
            "start": min(one.start, len(one.stops or one.steps) - 1),
            "beyond": list(scale.share_beyond(values)),
            "label": scale.title,
            "unit": scale.unit,
            "limits": list(scale.limits or ()),
            "table": self._table(scale.table()),
            "shading": VALUE_SHADING,
            "steps": steps,
            **stops,
        }

    def _strokes(self, line: Lines) -> list[dict[str, Any]]:
        """What is drawn of a line, one over the other, with the same arrays."""
        points, segments = self._numbers(line.points), self._codes(line.segments.astype(np.uint32))
        where = {"points": points, "segments": segments, "through": line.through}
        return [{**where, "color": color, "width": width} for color, width in line.strokes]

    def _table(self, colors: Any) -> dict[str, Any]:
        """Colours from the lower limit to the upper, then that of NaN."""
        return self._codes(np.rint(255.0 * np.concatenate([colors, [MISSING]])).astype(np.uint8))

    def _values(self, values: Floats, limits: tuple[float, float] | None) -> dict[str, Any]:
        """Numbers in steps of their range; as they are where one far away would leave few steps between the limits."""
        finite = values[np.isfinite(values)]
        if limits is not None and finite.size:
            with np.errstate(over="ignore"):
                coarse = np.ptp(finite) / LAST * COLOR_STEPS > limits[1] - limits[0]
            if coarse:
                return {**self._codes(exact_codes(np.where(np.isfinite(values), values, np.nan))), "exact": True}
        return self._numbers(values)

    def _numbers(self, values: Any) -> dict[str, Any]:
        found = quantised(values)
        return {**self._codes(found.codes), "low": list(found.low), "step": list(found.step), "gaps": found.gaps}

    def _codes(self, codes: Codes) -> dict[str, Any]:
        text = packed(codes)
        name = hashlib.sha256(text.encode()).hexdigest()[:20]
        self.arrays[name] = text
        return {"array": name, "type": codes.dtype.name, "columns": codes.shape[1]}


def _shows_its_outside(mesh: TriangleMesh) -> bool:
    """Whether no eye outside sees the inner side of a face: the mesh is closed, and its faces turn outward."""
    corners = mesh.vertices[mesh.faces[:, 0]]
    return mesh.is_closed and float((corners * mesh.face_cross_products).sum()) > 0.0
