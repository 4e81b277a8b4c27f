"""Edge-preserving geometry denoising: total variation of the face normals, then a vertex update."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numba import njit

from surfexp.contract.arrays import Floats, Integers
from surfexp.mesh.triangle_mesh import TriangleMesh
from surfexp.operators.fem import check_mesh
from surfexp.variational.fidelity import Progress
from surfexp.variational.separable_quadratic import check_positive
from surfexp.variational.solution import Solution

CHECK_INTERVAL = 10


@dataclass(frozen=True)
class NormalFiltering:
    """min over N of sum_e l_e |N_f - N_g| + alpha/2 sum_f A_f |N_f - N0_f|^2, then vertices moved to fit the normals.

    The normals found are scaled to unit length; the certificate is that of the convex problem before.

    Parameters
    ----------
    weight : float
        Weight without unit, alpha s h, s the spread of the normals across an edge, estimated by its median.
    vertex_steps : int
        Steps x_i += mean over the ring of N_f (N_f . (c_f - x_i)), c_f the centre of the face.
    tolerance : float
        Bound of the relative gap.
    iteration_limit : int

    References
    ----------
    Zhang, Wu, Zhang, Deng: Variational mesh denoising using total variation and piecewise constant function space (2015).
    Sun, Rosin, Martin, Langbein: Fast and effective feature-preserving mesh denoising (2007), for the vertex update.
    """

    weight: float = 0.5
    vertex_steps: int = 30
    tolerance: float = 1e-4
    iteration_limit: int = 5000

    def run(self, mesh: TriangleMesh, progress: Progress | None = None) -> Solution:
        """Return the moved vertices in `values`; the gap and the energy are those of the normals.

        Raises
        ------
        ValueError
            As `fem`, or if the weight is not positive.
        """
        check_positive("weight", self.weight)
        check_mesh(mesh)
        pairs, lengths = _inner_edges(mesh)
        jumps = np.linalg.norm(mesh.face_normals[pairs[:, 0]] - mesh.face_normals[pairs[:, 1]], axis=1)
        spread = max(float(np.median(jumps)), 1e-6)
        alpha = self.weight / (spread * mesh.edge_length)
        normals, rows = self._filter(mesh, pairs, lengths, alpha, progress)
        normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-12)
        iteration, energy, bound, gap = rows[-1]
        numbers = {"energy": energy, "lower_bound": bound, "relative_gap": gap, "iterations": iteration}
        history = np.array(rows).T
        return Solution(
            values=update_vertices(mesh, normals, self.vertex_steps),
            energy=energy,
            lower_bound=bound,
            relative_gap=gap,
            iterations=int(iteration),
            converged=gap <= self.tolerance,
            reason="gap below tolerance" if gap <= self.tolerance else "iteration limit",
            history={"iteration": history[0], "energy": history[1], "gap": history[3]},
            model="normal filtering",
            solver="primal_dual",
            metrics=numbers,
            notes=("The gap is that of the normals; the vertex update has none.",),
        )

    def _filter(
        self, mesh: TriangleMesh, pairs: Integers, lengths: Floats, alpha: float, progress: Progress | None
    ) -> tuple[Floats, list[tuple[float, float, float, float]]]:
        given, areas = mesh.face_normals, mesh.areas[:, None]
        inverse = 1.0 / mesh.areas
        steps = 1.0 / (3.0 * lengths * (inverse[pairs[:, 0]] + inverse[pairs[:, 1]]))
        normals, ahead = given.copy(), given.copy()
        dual, load = np.zeros((len(pairs), 3)), np.zeros_like(given)
        tau = 1.0 / alpha
        sigma = alpha
        rows = []
        for iteration in range(1, self.iteration_limit + 1):
            _edge_ascent(pairs, lengths, steps, sigma, ahead, dual, load)
            new = (normals - tau * load / areas + tau * alpha * given) / (1.0 + tau * alpha)
            momentum = 1.0 / np.sqrt(1.0 + 2.0 * alpha * tau)
            ahead = new + momentum * (new - normals)
            tau, sigma, normals = tau * momentum, sigma / momentum, new
            if iteration % CHECK_INTERVAL == 0 or iteration == self.iteration_limit:
                jumps = np.linalg.norm(normals[pairs[:, 0]] - normals[pairs[:, 1]], axis=1)
                energy = float(lengths @ jumps + 0.5 * alpha * (areas * (normals - given) ** 2).sum())
                bound = float((given * load).sum() - 0.5 / alpha * (load**2 / areas).sum())
                gap = (energy - bound) / max(energy, float(np.finfo(float).tiny))
                rows.append((float(iteration), energy, bound, gap))
                if progress is not None:
                    progress(iteration, gap)
                if gap <= self.tolerance:
                    break
        return normals, rows


def update_vertices(mesh: TriangleMesh, normals: Floats, steps: int) -> Floats:
    """Return vertices moved so that the faces turn towards the given normals (m, 3)."""
    vertices = mesh.vertices.copy()
    corners = mesh.faces.ravel()
    counts = np.bincount(corners, minlength=len(vertices))[:, None]
    for _ in range(steps):
        points = vertices[mesh.faces]
        offsets = points.mean(axis=1, keepdims=True) - points
        moves = np.einsum("fkx,fx,fy->fky", offsets, normals, normals).reshape(-1, 3)
        total = np.stack([np.bincount(corners, moves[:, x], len(vertices)) for x in range(3)], axis=1)
        vertices += total / np.maximum(counts, 1)
    return vertices


def normal_deviation(mesh: TriangleMesh, reference: TriangleMesh) -> float:
    """Return the area-weighted mean angle between the face normals of two meshes with the same faces, in degrees."""
    cosines = np.clip((mesh.face_normals * reference.face_normals).sum(axis=1), -1.0, 1.0)
    return float(np.degrees(reference.areas @ np.arccos(cosines) / reference.areas.sum()))


def _inner_edges(mesh: TriangleMesh) -> tuple[Integers, Floats]:
    """The pairs of faces at edges with two faces, and the lengths of those edges."""
    sides = mesh.face_edges.ravel()
    order = np.argsort(sides, kind="stable")
    inner = np.flatnonzero(mesh.edge_face_counts == 2)
    first = np.searchsorted(sides[order], inner)
    pairs = np.stack([order[first], order[first + 1]], axis=1) // 3
    ends = mesh.vertices[mesh.edges[inner]]
    return np.ascontiguousarray(pairs), np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1)


@njit(cache=True, nogil=True)
def _edge_ascent(
    pairs: Integers, lengths: Floats, steps: Floats, step: float, values: Floats, dual: Floats, load: Floats
) -> None:
    """Set p_e <- P(p_e + step s_e (N_f - N_g)); leaves the load of p."""
    load[:] = 0.0
    for e in range(len(pairs)):
        f, g = pairs[e, 0], pairs[e, 1]
        square = 0.0
        for x in range(3):
            dual[e, x] += step * steps[e] * (values[f, x] - values[g, x])
            square += dual[e, x] * dual[e, x]
        shrink = 1.0 / np.sqrt(max(square, 1.0))
        for x in range(3):
            dual[e, x] *= shrink
            load[f, x] += lengths[e] * dual[e, x]
            load[g, x] -= lengths[e] * dual[e, x]
