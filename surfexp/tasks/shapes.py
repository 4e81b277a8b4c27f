"""Generated surfaces by name."""

from __future__ import annotations

import importlib
import inspect
from typing import Any, Literal, get_args, get_origin

import numpy as np

from surfexp.mesh.given_numbers import one_of, real_number, whole_number
from surfexp.mesh.surface import Surface
from surfexp.mesh.validate import LARGEST_COORDINATE, SMALLEST_EXTENT

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
    one_of(name, "shape", SHAPES)
    generator = getattr(importlib.import_module(SHAPES[name]), name)
    described = inspect.signature(generator, eval_str=True).parameters
    known = list(described)
    unknown = set(parameters) - set(known)
    if unknown:
        raise ValueError(f"{name} has no parameter {min(unknown)!r}; it has {', '.join(known)}")
    made = generator(**{key: _taken(given, key, described[key].annotation) for key, given in parameters.items()})
    assert isinstance(made, Surface)  # noqa: S101, narrows a type
    return made


def _taken(given: Any, what: str, kind: Any) -> Any:
    """Return the value of a generator's parameter, of the type that it is said to have."""
    if kind is int:
        return whole_number(given, what, 0)
    if kind is float:
        number = real_number(given, what)
        if number and not SMALLEST_EXTENT < abs(number) < LARGEST_COORDINATE:
            sizes = f"{SMALLEST_EXTENT:g} to {LARGEST_COORDINATE:g}"
            raise ValueError(f"{what} = {number:g}, 0 or a number of size {sizes} is needed")
        return number
    if get_origin(kind) is tuple:
        needed = len(get_args(kind))
        if np.shape(given) != (needed,):
            raise ValueError(f"{what} = {given!r}, {needed} numbers are needed")
        return tuple(real_number(number, what) for number in given)
    return one_of(given, what, get_args(kind)) if get_origin(kind) is Literal else given
