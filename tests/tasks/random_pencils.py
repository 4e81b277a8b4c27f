"""Ordinary pencils as people hand them in, drawn by a seed: graphs, grids, clusters, components, any scale, complex."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import eigh
from scipy.sparse import block_diag, coo_array, csr_array, diags_array, random_array

KINDS = (
    "graph",
    "normalised graph",
    "path",
    "grid",
    "several components",
    "cluster",
    "small",
    "complex",
    "random",
    "scaled",
)


@dataclass(frozen=True, eq=False)
class DrawnPencil:
    """A pencil, how many pairs are asked for, and all its values by dense algebra."""

    kind: str
    stiffness: csr_array
    mass: csr_array | None
    k: int
    values: NDArray[np.float64]


def drawn_pencil(seed: int) -> DrawnPencil:
    """Draw one."""
    rng = np.random.default_rng(seed)
    kind = KINDS[seed % len(KINDS)]
    a = _stiffness(kind, rng)
    n = a.shape[0]
    mass: csr_array | None = None
    if rng.uniform() < 0.6:
        mass = csr_array(diags_array(rng.uniform(0.5, 2.0, n)))
    if mass is not None and rng.uniform() < 0.3:
        off = 0.1 * abs(a) / max(float(abs(a).max()), 1e-300)
        mass = csr_array(mass + off + diags_array(np.asarray(off.sum(axis=1))))
    scales = 1.0, 1.0
    if kind == "scaled":
        decades = rng.uniform(-140, 140, 2)
        scales = float(10.0 ** decades[0]), float(10.0 ** decades[1])
    dense_mass = np.eye(n) if mass is None else mass.toarray()
    values = eigh(a.toarray(), dense_mass, eigvals_only=True) * scales[0]
    if mass is not None:
        values, mass = values / scales[1], csr_array(mass * scales[1])
    return DrawnPencil(kind, csr_array(a * scales[0]), mass, int(rng.integers(1, min(n, 12) + 1)), values)


def _stiffness(kind: str, rng: np.random.Generator) -> csr_array:
    n = int(rng.integers(410, 600) if rng.uniform() < 0.1 else rng.integers(5, 200))
    match kind:
        case "small":
            return _laplacian(int(rng.integers(1, 5)), 2.0, rng)
        case "path":
            return _path(n)
        case "grid":
            side = int(rng.integers(3, 15))
            one, unit = _path(side), csr_array(np.eye(side))
            return csr_array(np.kron(one.toarray(), unit.toarray()) + np.kron(unit.toarray(), one.toarray()))
        case "several components":
            parts = [_laplacian(int(rng.integers(1, 60)), 4.0, rng) for _ in range(int(rng.integers(2, 9)))]
            return csr_array(block_diag(parts))
        case "cluster":
            return csr_array(np.diag(np.repeat(rng.uniform(0, 5, n), int(rng.integers(2, 9)))[:n]))
        case "complex":
            return _magnetic(_laplacian(n, 5.0, rng), rng)
        case "random":
            half = random_array((n, n), density=min(1.0, 3.0 / n), rng=rng, format="csr")
            return csr_array(half @ half.T)
        case "normalised graph":
            a = _laplacian(n, 6.0, rng)
            root = diags_array(1.0 / np.sqrt(np.maximum(a.diagonal(), 1e-12)))
            return csr_array(root @ a @ root)
    return _laplacian(n, float(rng.uniform(2.0, 10.0)), rng)


def _path(n: int) -> csr_array:
    degree = np.full(n, 2.0)
    degree[[0, -1]] = 1.0
    return csr_array(diags_array([-np.ones(n - 1), degree, -np.ones(n - 1)], offsets=[-1, 0, 1]))


def _laplacian(n: int, degree: float, rng: np.random.Generator) -> csr_array:
    """Laplacian of a random graph, whose mean degree is given: not always connected."""
    count = int(n * degree / 2)
    ends = rng.integers(0, n, (2, count))
    ends = ends[:, ends[0] != ends[1]]
    weights = rng.uniform(0.1, 1.0, ends.shape[1]) if rng.uniform() < 0.5 else np.ones(ends.shape[1])
    links = coo_array((np.tile(weights, 2), (np.concatenate(ends), np.concatenate(ends[::-1]))), shape=(n, n))
    return csr_array(diags_array(np.asarray(links.sum(axis=1))) - csr_array(links))


def _magnetic(laplacian: csr_array, rng: np.random.Generator) -> csr_array:
    """The same with a random phase on every edge."""
    entries = laplacian.tocoo()
    upper = entries.row < entries.col
    hops = entries.data[upper] * np.exp(2j * np.pi * rng.uniform(size=upper.sum()))
    above = csr_array((hops, (entries.row[upper], entries.col[upper])), shape=laplacian.shape)
    return csr_array(diags_array(laplacian.diagonal()) + above + above.conj().T)
