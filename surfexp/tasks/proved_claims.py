"""What a page can prove of a result: the arrays and numbers of its certificate."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from surfexp.contract.arrays import Floats
from surfexp.embedding.distance import Distance
from surfexp.embedding.spectral_embedding import Weighting
from surfexp.linalg.ldlt_ordering import nested_dissection
from surfexp.mesh.surface import Surface
from surfexp.mesh.surface_part import SurfacePart
from surfexp.operators.elements_surface import Boundary, Mass
from surfexp.operators.fem import fem
from surfexp.proof.claim import Claim
from surfexp.spectrum.eigensystem import EigenSystem, measure
from surfexp.spectrum.surface_spectrum import elements_of
from surfexp.tasks.denoised_map import DenoisedMap
from surfexp.tasks.embedded_surface import embedded_pairs
from surfexp.tasks.given_surface import SurfaceLike, as_surface
from surfexp.tasks.part_of_task import part_for

# a shift lies where neighbouring eigenvalues differ by more, relatively; stated numbers are refused that differ by more
CLEAR_GAP, OTHER_OPERATOR = 1e-6, 1e-6
# pairs of points for all bounds of a search over signs, of which a browser compares some ten million a second
MOST_COMPARISONS = 6e8


def gap_claim(result: DenoisedMap) -> Claim:
    """Return the claim that a denoised map is near the minimiser of its model.

    Raises
    ------
    ValueError
        If the map was not denoised by "rof" or "tgv", or the dual field that proves its gap was not kept.
    """
    proof = result.evidence
    if result.method not in ("rof", "tgv"):
        raise ValueError(f"a map after {result.method} has no duality gap: choose method rof or tgv")
    if proof is None or proof.solution.lower_bound is None:
        weight = result.certificate.get("weight")
        at = "" if weight is None else f", weight={weight:g}"
        raise ValueError(
            f"the map after {result.method} has no dual field with it, as of a path: give that of "
            f"denoise(..., method='{result.method}'{at})"
        )
    solution, dual, facts = proof.solution, proof.solution.dual, result.certificate
    arrays: dict[str, NDArray[Any]] = {
        **_mesh_of(proof.part),
        "map": proof.map,
        "values": solution.values,
        "dual": np.asarray(dual),
    }
    tgv = result.method == "tgv"
    if tgv:
        arrays["slopes"] = proof.slopes
    return Claim(
        "duality gap",
        arrays,
        {
            "model": "TGV" if tgv else "ROF",
            "weight": facts["weight"],
            "noise": facts["noise"],
            "ratio": facts.get("ratio", 0.0),
            "tolerance": proof.tolerance,
        },
        {
            "energy": solution.energy,
            "lower_bound": solution.lower_bound,
            "relative_gap": facts["relative_gap"],
            "error_bound": facts["error_bound"],
        },
    )


def spectrum_claim(
    system: EigenSystem,
    surface: SurfaceLike,
    mass: Mass = "consistent",
    boundary: Boundary = "neumann",
    tolerance: float = 1e-8,
) -> Claim:
    """Return the claim that pairs are eigenpairs and that none is missing below a shift.

    Raises
    ------
    ValueError
        If the pairs are not those of linear elements on the surface, or not the lowest ones.
    """
    owner = as_surface(surface)
    part = part_for(owner)
    vectors = np.asarray(part.restrict(system.vectors), dtype=np.float64)
    elements = elements_of(Surface(part.mesh, owner.name, owner.unit), fem(part.mesh), 1, mass=mass, boundary=boundary)
    inside = np.asfortranarray(vectors[elements.free])
    shift, certified = _shift(system)
    found = measure(elements.stiffness, elements.mass, inside, spacing=shift / certified)
    apart = float(np.abs(found.values - system.values).max() / max(float(system.values[-1]), found.spacing))
    if system.order != 1 or apart > OTHER_OPERATOR or found.residuals.max() > tolerance:
        raise ValueError(
            f"the pairs differ by {apart:.1e}, residual {found.residuals.max():.1e}, from those of linear elements on the "
            f"surface with mass {mass} and boundary {boundary}: give the surface, mass and boundary that they were found on"
        )
    pattern = elements.stiffness
    return Claim(
        "spectrum",
        {
            **_mesh_of(part),
            "values": system.values,
            "vectors": vectors.T,
            "residuals": found.residuals,
            "order": nested_dissection(pattern.indptr.astype(np.int64), pattern.indices.astype(np.int64)),
        },
        {"mass": mass, "boundary": boundary, "shift": shift, "certified": certified, "tolerance": tolerance},
        {"orthogonality": found.orthogonality, "area": elements.area},
    )


def sign_claims(
    found: Distance, source: SurfaceLike, target: SurfaceLike, weighting: Weighting = "biharmonic"
) -> tuple[Claim, Claim, Claim]:
    """Return the claims of both spectra, and that no signs of the target's modes give a smaller distance.

    Raises
    ------
    ValueError
        If the distance is not that of the two surfaces, or has no search over signs, or one that takes a browser minutes.
    """
    if weighting not in ("biharmonic", "global_point") or not len(found.closed):
        raise ValueError(
            f"weighting {weighting!r} with {len(found.closed)} closed nodes: choose biharmonic or global_point"
        )
    comparisons = len(found.source_points) * len(found.target_points) * len(found.closed)
    if comparisons > MOST_COMPARISONS:
        raise ValueError(
            f"{len(found.closed)} bounds over {len(found.source_points)} times {len(found.target_points)} points would take a "
            f"browser minutes, at most {MOST_COMPARISONS:.0e} comparisons: take coarser surfaces or fewer eigenfunctions"
        )
    dimension = len(found.basis)
    pairs = [embedded_pairs(one, dimension, weighting) for one in (source, target)]
    signs = np.diag(found.basis)
    in_their_basis = (found.source_points, found.target_points * signs)
    for (embedding, _, part), points in zip(pairs, in_their_basis, strict=True):
        inside = np.asarray(part.restrict(points), dtype=np.float64)
        if inside.shape != embedding.points.shape or not _same(inside, embedding.points):
            raise ValueError(
                f"the distance is not that of these surfaces with weighting {weighting}: give the ones it is of"
            )
    spectra = []
    for _, system, part in pairs:
        claim = spectrum_claim(system, (part.mesh.vertices, part.mesh.faces))
        spectra.append(replace(claim, arrays={**claim.arrays, **_mesh_of(part)}))
    first, second = pairs[0][2], pairs[1][2]
    number = np.full(first.whole_count, -1, dtype=np.int64)
    number[first.vertices] = np.arange(len(first.vertices))
    claim = Claim(
        "signs",
        {
            "signs": signs.astype(np.int64),
            "closed": found.closed,
            "correspondence": number[np.asarray(second.restrict(found.correspondence), dtype=np.int64)],
        },
        {"spectra": [0, 1], "dimension": dimension, "weighting": weighting},
        {"value": found.value, "lower_bound": found.lower_bound, "optimal": found.optimal},
    )
    return spectra[0], spectra[1], claim


def _mesh_of(part: SurfacePart) -> dict[str, NDArray[Any]]:
    """The arrays of a part: its mesh, and which rows of the whole its vertices are where it is a part."""
    arrays = {"vertices": part.mesh.vertices, "faces": part.mesh.faces}
    return arrays if part.is_whole else {**arrays, "rows": part.vertices}


def _same(points: Floats, others: Floats) -> bool:
    return bool(np.abs(points - others).max() <= OTHER_OPERATOR * np.abs(others).max())


def _shift(system: EigenSystem) -> tuple[float, int]:
    """Return a shift with a certified count of pairs below it: that of the proof, else the last clear gap between pairs."""
    values, count = system.values, len(system.values)
    if not count:
        raise ValueError("there are 0 pairs, a page proves 1 or more: give the first pairs, as eigenpairs finds them")
    for shift, below in system.inertia:
        if shift < values[-1] and below != (inside := int((values < shift).sum())):
            raise ValueError(
                f"{below} eigenvalues lie below {shift:.6g}, the pairs have {inside} of them: give the first pairs, as "
                "eigenpairs or Spectrum.first finds them"
            )
    for shift, below in reversed(system.inertia):
        if below == count and shift > values[-1]:
            return float(shift), count
    gaps = np.diff(values) / np.maximum(values[1:], np.finfo(float).tiny)
    clear = np.flatnonzero(gaps > max(CLEAR_GAP, 0.1 * float(gaps[1:].max(initial=0.0))))
    if not len(clear):
        raise ValueError(f"{count} eigenvalues have no gap between them: take more pairs")
    last = int(clear[-1])
    return float(values[last : last + 2].mean()), last + 1
