"""The surfaces of all figures of a page: what turns, and why the rest stays still."""

from __future__ import annotations

from collections.abc import Mapping
from functools import lru_cache, partial
from pathlib import Path
from typing import Any

from surfexp.lab.errors import DamagedResult
from surfexp.lab.plan.plan import Node
from surfexp.lab.store import store
from surfexp.report.turning.scene import scene_of
from surfexp.viewer.page import SCRIPTS
from surfexp.viewer.payload import Payload


class Turning:
    """The scenes of a page and their common payload; results are read from a folder as they are needed.

    Parameters
    ----------
    results : Path
    payload : Payload, optional
    """

    def __init__(self, results: Path, payload: Payload | None = None) -> None:
        self.payload = payload or Payload()
        self._load = lru_cache(maxsize=4)(partial(store.load, results))
        self._found: dict[str, dict[str, Any]] = {}

    @property
    def scripts(self) -> tuple[str, ...]:
        """The scripts that the page needs: none where nothing turns."""
        return SCRIPTS if self.payload.arrays else ()

    def of(self, nodes: Mapping[str, Node], key: str) -> dict[str, Any]:
        """`scene`, by which a page turns a figure, or `still`, why it cannot; neither where it takes no surface."""
        if key not in self._found:
            self._found[key] = self._read(nodes, key)
        return self._found[key]

    def _read(self, nodes: Mapping[str, Node], key: str) -> dict[str, Any]:
        try:
            scene = scene_of(nodes, key, self._load)
            return {} if scene is None else {"scene": self.payload.add(scene)}
        except (DamagedResult, ValueError) as error:
            return {"still": str(error)}
        except Exception as error:  # whatever was stored: the page is written, with its still picture
            return {"still": f"its surfaces could not be read ({type(error).__name__})"}
