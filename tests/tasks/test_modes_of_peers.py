"""Modes of a masked cortex beside those of LaPy and neuromodes on the mesh that is cut, and our solver inside them."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import surfexp as sx
from surfexp.mesh.noise import add_vertex_noise
from surfexp.mesh.shapes.icosphere import icosphere

pytest.importorskip("lapy", reason="pip install lapy neuromodes")
neuromodes = pytest.importorskip("neuromodes", reason="pip install neuromodes")

DATA = Path(neuromodes.__file__).parent / "data"


def files(density: str) -> tuple[Path, Path]:
    stem = f"sp-human_tpl-fsLR_den-{density}_hemi-L"
    return DATA / f"{stem}_midthickness.surf.gii", DATA / f"{stem}_medmask.label.gii"


@pytest.mark.parametrize(("density", "count"), [("4k", 50), pytest.param("32k", 100, marks=pytest.mark.slow)])
def test_modes_of_a_masked_cortex_equal_those_of_the_cut_mesh(density: str, count: int) -> None:
    from lapy import Solver, TriaMesh
    from neuromodes.eigen import EigenSolver
    from neuromodes.io import fetch_example_surf

    surface, mask = files(density)
    cortex = sx.read(surface, mask=mask)
    ours = sx.eigenpairs(cortex, count)
    assert ours.complete and ours.residuals.max() <= 1e-8
    theirs = EigenSolver(*fetch_example_surf(density=density)).solve(count, seed=0)
    cut = theirs.geometry
    values, vectors = Solver(TriaMesh(cut.v, cut.t), use_cholmod=False).eigs(count, rng=0)
    inside = np.isfinite(ours.vectors[:, 0])
    assert inside.sum() == len(cut.v)
    for found, modes in ((theirs.evals, theirs.emodes), (values, vectors)):
        assert np.abs(ours.values - found).max() <= 1e-8 * ours.values[-1]
        # signs and rotations inside of clusters are free: the spans agree
        mass = theirs.mass
        overlaps = np.linalg.svd(ours.vectors[inside].T @ (mass @ modes), compute_uv=False)
        assert overlaps.min() > 1 - 1e-6


def test_our_eigsh_takes_the_place_of_scipys_in_lapy_and_neuromodes(monkeypatch: pytest.MonkeyPatch) -> None:
    from lapy import Solver, TriaMesh, solver
    from neuromodes.eigen import EigenSolver
    from neuromodes.io import fetch_example_surf

    plain = EigenSolver(*fetch_example_surf(density="4k")).solve(20, seed=0)
    calls = []

    def swapped(*arguments, **options):
        calls.append(options["k"] if "k" in options else arguments[1])
        return sx.eigsh(*arguments, **options)

    monkeypatch.setattr(solver, "_eigsh", swapped)
    cut = plain.geometry
    values, _ = Solver(TriaMesh(cut.v, cut.t), use_cholmod=False).eigs(20)
    again = EigenSolver(*fetch_example_surf(density="4k")).solve(20, seed=0)
    assert len(calls) == 2
    for found in (values, again.evals):
        assert np.abs(found - plain.evals).max() <= 1e-8 * plain.evals[-1]


def test_lapy_leaves_pairs_out_on_an_icosphere_and_returns_them_where_noise_is() -> None:
    """Some of 27 runs, by its own matrices; which of them is a matter of rounding."""
    from lapy import Solver, TriaMesh

    def missing(sigma: float) -> int:
        ball = add_vertex_noise(icosphere(2), sigma)
        known, found = sx.eigenpairs(ball, 70).values, 0
        for count in (20, 21, 23, 30, 31, 34, 35, 46, 50):
            for seed in range(3):
                values, _ = Solver(TriaMesh(ball.mesh.vertices, ball.mesh.faces), use_cholmod=False).eigs(
                    count, rng=seed
                )
                below = np.searchsorted(known, np.sort(values) - 1e-6 * (1.0 + values.max()))
                found += bool((below > np.arange(count)).any())
        return found

    assert missing(0.0) > 0
    assert missing(1e-6) == 0
