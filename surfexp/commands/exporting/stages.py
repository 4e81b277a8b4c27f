"""An export: stage by stage, each file with its certificate, all of them in one index."""

from __future__ import annotations

import dataclasses
from collections.abc import Iterator, Mapping, Sequence
from functools import lru_cache
from pathlib import Path
from typing import Any

# each module brings the writers of its classes
from surfexp.commands.certificate import write_certificate
from surfexp.commands.exporting import matrices as matrices
from surfexp.commands.exporting import on_surfaces as on_surfaces
from surfexp.commands.exporting import tables as tables
from surfexp.commands.exporting.folder import ExportFolder
from surfexp.commands.exporting.further_files import write_further_files
from surfexp.commands.exporting.names import Named, names_of
from surfexp.commands.exporting.selection import surfaces_of
from surfexp.commands.exporting.writers import Place, maps_of, write
from surfexp.lab.errors import DamagedResult
from surfexp.lab.plan.outcome import NOT_COMPUTED, Outcome, outcome
from surfexp.lab.plan.plan import Node, Plan
from surfexp.lab.store import store
from surfexp.mesh.surface import Surface


class Export:
    """Results of one plan on their way into a folder.

    Parameters
    ----------
    plan : Plan
    results : Path
    folder : ExportFolder
        Entered.
    matrix_market : bool
        Whether matrices are written as .mtx too.
    for_print : bool
        Whether plots are written as .pdf and at 300 dots an inch too.
    """

    def __init__(
        self, plan: Plan, results: Path, folder: ExportFolder, matrix_market: bool = False, for_print: bool = False
    ) -> None:
        self.plan, self.results, self.folder = plan, results, folder
        self.matrix_market, self.for_print = matrix_market, for_print
        self.names = names_of(plan, results)
        self.carried: dict[str, dict[str, Any]] = {}
        self.rows: list[dict[str, Any]] = []
        self.surface = lru_cache(maxsize=4)(self._surface)

    def stages(self, nodes: Sequence[Node]) -> Iterator[str]:
        """Write stages, one at each step: yields "", or what is left out, why, and how to finish it."""
        for node in nodes:
            found = outcome(self.results, node)
            if found.failure:
                yield self._left_out(node, found.failure)
                continue
            place = self._place(node)
            try:
                yield self._write(node, found, place)
            except DamagedResult as error:
                self.folder.drop(place.files)
                yield self._left_out(node, str(error))
            except (ValueError, TypeError) as error:
                self.folder.drop(place.files)
                yield f"{node.kind}/{node.plugin} {place.stem} cannot be written: {error}"

    def _place(self, node: Node) -> Place:
        picture = self.results / self.plan.settings.experiment / "figures" / f"{node.plugin}-{node.key[:8]}.png"
        return Place(
            self.folder,
            self.names[node.key].stem,
            carried=self.carried.get(node.key, {}),
            picture=picture if node.kind == "figure" and picture.exists() else None,
            matrix_market=self.matrix_market,
            for_print=self.for_print,
        )

    def _write(self, node: Node, found: Outcome, place: Place) -> str:
        named, missing = self.names[node.key], ""
        result = store.load(self.results, node.kind, node.key)
        maps = maps_of(result)
        on = self._under(node, len(next(iter(maps.values())))) if maps else ""
        place.surface = self.surface(on) if on else None
        write(result, place)
        self.carried.setdefault(on, {}).update({f"{place.stem} {part}".rstrip(): one for part, one in maps.items()})
        try:
            write_further_files(self.plan, node, self.results, place)
        except DamagedResult as error:
            missing = f"further files, {self._left_out(node, str(error))}"
        for file in place.files:
            self._certify(file, node, named, found, result, place.carried)
            facts = {"kind": node.kind, "plugin": node.plugin, "comparison": named.comparison, "label": named.label}
            self.rows.append({"file": file.name, **facts, **named.parameters, "key": node.key, **found.metrics})
        return missing

    def _surface(self, key: str) -> Surface | None:
        try:
            surface: Surface = store.load(self.results, "surface", key)
        except DamagedResult:
            return None
        return surface

    def _under(self, node: Node, count: int) -> str:
        """The key of the one surface with so many vertices that a result was made on; "" where there is not one."""
        found = {key: self.surface(key) for key in surfaces_of(self.plan, node.key)}
        fitting = [key for key, surface in found.items() if surface and len(surface.mesh.vertices) == count]
        return fitting[0] if len(fitting) == 1 else ""

    def _certify(
        self, file: Path, node: Node, named: Named, found: Outcome, result: Any, carried: Mapping[str, Any]
    ) -> None:
        plain = {item.name: getattr(result, item.name) for item in dataclasses.fields(result)}
        facts: dict[str, Any] = {
            "key": node.key,
            "experiment": self.plan.settings.experiment,
            "comparison": named.comparison,
            "label": named.label,
            "parameters": dict(named.parameters),
            "result": {name: value for name, value in plain.items() if isinstance(value, bool | int | float | str)},
            "metrics": found.metrics,
            **({"maps of other results": list(carried)} if carried else {}),
        }
        write_certificate(file, f"{node.kind}/{node.plugin}", node.options, node.inputs, facts, found.notes)

    def _left_out(self, node: Node, reason: str) -> str:
        """What is left out, and the command that finishes it."""
        state = "is not finished" if reason == NOT_COMPUTED else f"has no result ({reason})"
        settings = self.plan.settings
        elsewhere = "" if self.results == Path("results") else f" results={self.results}"
        name = self.names[node.key].stem
        return f"{node.kind}/{node.plugin} {name} {state}: surfexp run experiment={settings.experiment}{elsewhere}"
