"""Generated surfaces by name."""

from __future__ import annotations

import importlib
import inspect
from typing import Any

from surfexp.mesh.surface import Surface

SHAPES = {
    "icosphere": "surfexp.mesh.shapes.icosphere",
    "torus": "surfexp.mesh.shapes.torus",
    "disk": "surfexp.mesh.shapes.disk",
    "rectangle": "surfexp.mesh.shapes.rectangle",
    "ellipsoid": "surfexp.mesh.shapes.ellipsoid",
    "cup": "surfexp.mesh.shapes.cup",
    "cortex": "surfexp.mesh.shapes.cortex",
    "fsaverage5": "surfexp.anatomy.fsaverage5",
}


def shape(name: str, **parameters: Any) -> Surface:
    """Return a generated surface, or the average cortex that comes with nilearn.

    Parameters
    ----------
    name : "icosphere", "torus", "disk", "rectangle", "ellipsoid", "cup", "cortex" or "fsaverage5"
    **parameters
        Parameters of the generator.

    Returns
    -------
    Surface

    Raises
    ------
    ValueError
        If the name or a parameter is unknown.

    Examples
    --------
    >>> import surfexp as sx
    >>> len(sx.shape("icosphere", levels=2).mesh.vertices)
    162
    """
    if name not in SHAPES:
        raise ValueError(f"shape {name!r} is unknown, choose one of {', '.join(SHAPES)}")
    generator = getattr(importlib.import_module(SHAPES[name]), name)
    known = list(inspect.signature(generator).parameters)
    unknown = set(parameters) - set(known)
    if unknown:
        raise ValueError(f"{name} has no parameter {min(unknown)!r}; it has {', '.join(known)}")
    made = generator(**parameters)
    assert isinstance(made, Surface)  # noqa: S101, narrows a type
    return made
