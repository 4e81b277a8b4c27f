"""What is said of a surface in words and few numbers, as JSON in its archive.

Checked by hand: files belong to the core, which is installed without pydantic.
"""

from __future__ import annotations

import json
from typing import Any

import numpy as np

from surfexp.contract.arrays import Integers
from surfexp.mesh.coloured_labels import Colour, ColouredLabels
from surfexp.mesh.label_map import LabelMap
from surfexp.mesh.spatial_frame import CoordinateTransform, SpatialFrame
from surfexp.mesh.surface_facts import SurfaceFacts


def written_record(frame: SpatialFrame, facts: SurfaceFacts) -> str:
    """Return the record of a surface; nothing where there is nothing to say."""
    if not (facts.unit or facts.labels or frame.volume or frame.transforms or frame.metadata):
        return ""
    record = {
        "unit": facts.unit,
        "labels": {name: _table(labels) for name, labels in facts.labels.items()},
        "volume": {key: _plain(value) for key, value in frame.volume.items()},
        "transforms": [[one.source, one.target, one.matrix.tolist()] for one in frame.transforms],
        "metadata": dict(frame.metadata),
    }
    return json.dumps(record)


class SurfaceRecord:
    """A record that anybody may have sent.

    Parameters
    ----------
    text : str

    Raises
    ------
    ValueError
        In one line, if it is none.
    """

    def __init__(self, text: str) -> None:
        self._parts = _mapping(json.loads(text), "its record")

    @property
    def unit(self) -> str:
        """The unit of length."""
        return _word(self._parts.get("unit", ""), "its unit")

    @property
    def frame(self) -> SpatialFrame:
        """Where the vertices lie."""
        volume = {key: _numbers_or_word(value, key) for key, value in self._part("volume").items()}
        transforms = tuple(_transform(one) for one in self._parts.get("transforms", []))
        metadata = {key: _word(value, f"its metadata {key!r}") for key, value in self._part("metadata").items()}
        return SpatialFrame(volume, transforms, metadata)

    @property
    def label_names(self) -> tuple[str, ...]:
        """What its labels are called."""
        return tuple(self._part("labels"))

    def labels(self, name: str, keys: Integers) -> LabelMap:
        """Return the labels of a name with what their numbers stand for."""
        what = f"its labels {name!r}"
        table = _mapping(self._part("labels")[name], what)
        names = {int(key): _word(said, what) for key, said in _mapping(table.get("names"), what).items()}
        colors = {int(key): _colour(color, what) for key, color in _mapping(table.get("colors", {}), what).items()}
        return ColouredLabels(keys, names, colors) if colors else LabelMap(keys, names)

    def _part(self, name: str) -> dict[str, Any]:
        return _mapping(self._parts.get(name, {}), f"its {name}")


def _table(labels: LabelMap) -> dict[str, Any]:
    colors = labels.colors if isinstance(labels, ColouredLabels) else {}
    return {
        "names": {str(key): name for key, name in labels.names.items()},
        "colors": {str(key): list(color) for key, color in colors.items()},
    }


def _plain(value: Any) -> Any:
    """A value of FreeSurfer's header as JSON has it: bytes are text, arrays lists."""
    if isinstance(value, bytes):
        return value.decode("utf-8", "replace")
    return value.tolist() if isinstance(value, np.ndarray | np.generic) else value


def _mapping(value: Any, what: str) -> dict[str, Any]:
    if not isinstance(value, dict):
        raise ValueError(f"{what} is no mapping of names")
    return value


def _word(value: Any, what: str) -> str:
    if not isinstance(value, str):
        raise ValueError(f"{what} is {value!r}, a word is needed")
    return value


def _numbers_or_word(value: Any, key: str) -> Any:
    if isinstance(value, str | int | float):
        return value
    found = np.array(value)
    if found.dtype.kind not in "if" or found.ndim != 1:
        raise ValueError(f"its volume geometry {key!r} is no list of numbers")
    return found


def _transform(value: Any) -> CoordinateTransform:
    source, target, matrix = value
    found = np.array(matrix, dtype=np.float64)
    if found.shape != (4, 4):
        raise ValueError(f"a coordinate transform has shape {found.shape}, (4, 4) is needed")
    return CoordinateTransform(_word(source, "a space"), _word(target, "a space"), found)


def _colour(value: Any, what: str) -> Colour:
    if not isinstance(value, list) or len(value) != 3 or not all(0.0 <= float(channel) <= 1.0 for channel in value):
        raise ValueError(f"{what} have the colour {value!r}, three shares from 0 to 1 are needed")
    red, green, blue = map(float, value)
    return red, green, blue
