"""The statistics by their definitions, one threshold and one rearrangement at a time."""

from __future__ import annotations

import numpy as np
from hypothesis import strategies as st
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from surfexp.mesh.shapes.icosphere import icosphere
from surfexp.mesh.triangle_mesh import TriangleMesh


def components(edges: np.ndarray, inside: np.ndarray) -> np.ndarray:
    """Number of the component of each vertex inside, -1 outside."""
    kept = edges[inside[edges].all(axis=1)]
    graph = coo_array((np.ones(len(kept)), (kept[:, 0], kept[:, 1])), shape=(len(inside), len(inside)))
    return np.where(inside, connected_components(graph, directed=False)[1], -1)


def enhanced_by_definition(
    values: np.ndarray, edges: np.ndarray, areas: np.ndarray, extent_power: float, height_power: float
) -> np.ndarray:
    """The integral over thresholds, which is elementary between two values of the map."""
    known = np.where(np.isfinite(values), values, 0.0)
    found = np.zeros(len(values))
    for sign in (1.0, -1.0):
        below = 0.0
        for height in np.unique(sign * known[sign * known > 0.0]):
            labels = components(edges, sign * known >= height)
            inside = labels >= 0
            area = np.bincount(labels[inside], areas[inside])[labels[inside]]
            step = (height ** (height_power + 1.0) - below ** (height_power + 1.0)) / (height_power + 1.0)
            found[inside] += sign * area**extent_power * step
            below = height
    return found


def enhanced_by_steps(
    values: np.ndarray, edges: np.ndarray, areas: np.ndarray, extent_power: float, height_power: float, step: float
) -> np.ndarray:
    """The sum over thresholds step, 2 step, ..., as it is commonly computed."""
    found = np.zeros(len(values))
    for sign in (1.0, -1.0):
        for height in step * np.arange(1, int((sign * values).max() / step) + 2):
            labels = components(edges, sign * values >= height)
            inside = labels >= 0
            area = np.bincount(labels[inside], areas[inside])[labels[inside]]
            found[inside] += sign * area**extent_power * height**height_power * step
    return found


def t_by_definition(data: np.ndarray, design: np.ndarray, contrast: np.ndarray) -> np.ndarray:
    """t of a contrast at each column by least squares."""
    coefficients, _, rank, _ = np.linalg.lstsq(design, data, rcond=None)
    rest = ((data - design @ coefficients) ** 2).sum(axis=0) / (len(data) - rank)
    return contrast @ coefficients / np.sqrt(rest * (contrast @ np.linalg.pinv(design.T @ design) @ contrast))


@st.composite
def meshes(draw: st.DrawFn) -> TriangleMesh:
    """Some faces of one or two spheres or of a grid: open, with holes, pinched, in several components, with lone vertices."""
    ball = icosphere(levels=draw(st.integers(0, 1))).mesh
    width = draw(st.integers(2, 5))
    corners = np.arange(width * width).reshape(width, width)
    low = np.stack([corners[:-1, :-1], corners[1:, :-1], corners[:-1, 1:]], axis=-1).reshape(-1, 3)
    high = np.stack([corners[1:, :-1], corners[1:, 1:], corners[:-1, 1:]], axis=-1).reshape(-1, 3)
    places = np.stack([*np.divmod(np.arange(width * width), width), np.zeros(width * width)], axis=1).astype(float)
    parts = draw(
        st.lists(
            st.sampled_from([(ball.vertices, ball.faces), (places, np.vstack([low, high]))]), min_size=1, max_size=2
        )
    )
    shifts = np.cumsum([0, *(len(vertices) for vertices, _ in parts)])
    vertices = np.vstack([part + 10.0 * k for k, (part, _) in enumerate(parts)])
    faces = np.vstack([part + shift for (_, part), shift in zip(parts, shifts[:-1], strict=True)])
    random = np.random.default_rng(draw(st.integers(0, 2**32 - 1)))
    kept = random.random(len(faces)) < draw(st.sampled_from([1.0, 0.8, 0.4]))
    kept[0] = True
    return TriangleMesh(vertices * random.uniform(0.5, 2.0, 3), faces[kept])


@st.composite
def maps_with_ties(draw: st.DrawFn, count: int) -> np.ndarray:
    """Few different values, both signs, zeros, and NaN at masked vertices; or all values different."""
    random = np.random.default_rng(draw(st.integers(0, 2**32 - 1)))
    values = random.standard_normal(count)
    if draw(st.booleans()):
        values = np.round(values * draw(st.sampled_from([1.0, 3.0]))) / 2.0
    values[random.random(count) < draw(st.sampled_from([0.0, 0.2]))] = np.nan
    return values
