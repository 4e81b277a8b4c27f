"""The surfaces of a figure as a page turns them: those among the inputs of its stage, with what belongs to each."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace
from typing import Any

import numpy as np

from surfexp.figures.camera import View, viewing_direction
from surfexp.figures.colormap import ColorScale
from surfexp.lab.plan.plan import Node
from surfexp.mesh.surface import Surface
from surfexp.mesh.triangle_mesh import TriangleMesh
from surfexp.report.turning.fields import feature_field, image_fields, mode_field
from surfexp.variational.solution import Solution
from surfexp.viewer.scene import Drawn, Field, Scene, Step

Load = Callable[[str, str], Any]
# results that belong to a surface, with their stages, by kind and label
Given = Mapping[str, Mapping[str, tuple[Any, Node]]]
KINDS = ("image", "solver", "eigensolver", "feature", "skeleton")

# beyond these a browser has too much to draw at once
SURFACES, PANELS = 6, 4


def scene_of(nodes: Mapping[str, Node], key: str, load: Load) -> Scene | None:
    """The scene of a figure's stage; None where it takes no surface.

    Parameters
    ----------
    nodes : dict of str to Node
        The stages of a plan.
    key : str
        That of the figure.
    load : callable
        Gives the stored result of a kind and a key.

    Raises
    ------
    ValueError
        If it takes more surfaces than a page can turn at once.
    """
    inputs = dict(_labelled(nodes[key]))
    found = {label: one for label, one in inputs.items() if nodes[one].kind == "surface"}
    if not found:
        return None
    if len(found) > SURFACES:
        raise ValueError(f"{len(found)} surfaces are more than the {SURFACES} that a page turns at once")
    owners = {label: _nearest(nodes, one, set(found.values())) for label, one in inputs.items() if label not in found}
    options, surfaces = nodes[key].options, list[Drawn]()
    for label, surface in found.items():
        own = {name: nodes[inputs[name]] for name, owner in owners.items() if owner == surface}
        given = {
            kind: {name: (load(kind, node.key), node) for name, node in own.items() if node.kind == kind}
            for kind in KINDS
        }
        surfaces += _drawn(label, load("surface", surface), given, options)
    return Scene(surfaces, _panels(surfaces), _view(options, surfaces[0].mesh))


def _labelled(node: Node) -> Iterator[tuple[str, str]]:
    """Each input of a stage with what it is called: its role, or its label in a collection."""
    for role, value in node.inputs.items():
        if isinstance(value, str):
            yield role, value
            continue
        members = value.items() if isinstance(value, Mapping) else enumerate(value, 1)
        yield from ((f"{role} {label}", one) for label, one in members)


def _nearest(nodes: Mapping[str, Node], key: str, wanted: set[str]) -> str:
    """The stage among those wanted that a stage is made from in the fewest steps; empty where there is none."""
    seen, front = {key}, [key]
    while front:
        if reached := [one for one in front if one in wanted]:
            return reached[0]
        front = [child for one in front for child in nodes[one].children if child not in seen]
        seen.update(front)
    return ""


def _drawn(label: str, surface: Surface, given: Given, options: Mapping[str, Any]) -> list[Drawn]:
    """A surface with its fields; where a result is the surface moved, that too."""
    mesh, fields, moved = surface.mesh, list[Field](), list[Drawn]()
    solution: Solution | None = next((one for one, _ in given["solver"].values()), None)
    for image, _ in given["image"].values():
        fields += image_fields(mesh, image, solution, str(options.get("colormap", "viridis")))
    if solution is not None and not given["image"] and solution.values.shape == mesh.vertices.shape:
        moved.append(Drawn("result", TriangleMesh(solution.values, mesh.faces), [Field("surface")]))
    fields += [mode_field(mesh, system) for system, _ in given["eigensolver"].values()]
    for name, (feature, node) in given["feature"].items():
        skeleton = next((one for one, made in given["skeleton"].values() if node.key in made.children), None)
        one = feature_field(mesh, feature, skeleton)
        fields.append(one if len(given["feature"]) == 1 else replace(one, name=name))
    if not fields:
        fields = [Field(name, (Step(values),), ColorScale(name)) for name, values in surface.scalars.items()]
    fields = [_masked(one, surface) for one in fields] or [Field("surface")]
    return [Drawn(label, mesh, fields), *moved]


def _masked(one: Field, surface: Surface) -> Field:
    """The field without values outside the mask, where methods do not work."""
    if surface.mask is None:
        return one
    inside = surface.mask
    hidden = (None if step.values is None else np.where(inside, step.values, np.nan) for step in one.steps)
    return replace(one, steps=tuple(replace(s, values=v) for s, v in zip(one.steps, hidden, strict=True)))


def _panels(surfaces: list[Drawn]) -> list[tuple[int, int]]:
    """The fields of one surface side by side, or the first field of each of several."""
    if len(surfaces) > 1:
        return [(k, 0) for k in range(len(surfaces))]
    return [(0, k) for k in range(min(len(surfaces[0].fields), PANELS))]


def _view(options: Mapping[str, Any], mesh: TriangleMesh) -> tuple[float, float]:
    """The first direction from which the figure shows its surfaces."""
    view: View = "oblique"
    if "azimuth" in options and "elevation" in options:
        view = (options["azimuth"], options["elevation"])
    elif named := options.get("view") or next(iter(options.get("views") or ()), None):
        view = named if isinstance(named, str) else (named[0], named[1])
    return viewing_direction(view, mesh)
