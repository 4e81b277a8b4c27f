"""What a person costs: processor seconds of each descriptor, of a distance of pairs, and for 10,000 people on paper.

Run with `python -m audits.benchmarks.fingerprint_costs` on a quiet machine with one thread. Left putamina of 2,500 vertices of
three donors, none of which is in the study; everything is done once before the clock starts.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from itertools import combinations
from time import process_time

import numpy as np

from surfexp.anatomy.label_volume import DONORS
from surfexp.embedding.distance_methods import Pairing
from surfexp.embedding.spectral_embedding import spectral_embedding
from surfexp.operators.fem import fem
from surfexp.spectrum.nodal_signature import counted_domains
from surfexp.spectrum.shape_distributions import embedding_distances, heat_distribution, wave_distribution
from surfexp.spectrum.surface_spectrum import graph_of, surface_spectrum
from surfexp_studies.fingerprints.certificate import value_radii
from surfexp_studies.fingerprints.descriptors import MODES
from surfexp_studies.fingerprints.people import subcortical_person
from surfexp_studies.fingerprints.usual_spectrum import usual_spectrum

COHORT, QUERIES = 10_000, 1


def tasks(donor: str) -> dict[str, Callable[[], object]]:
    """What is done for one person, by name."""
    make = partial(subcortical_person, donor, "putamen", "left", 0)
    surface = make()
    operator, areas = fem(surface.mesh), surface.mesh.vertex_areas
    system = surface_spectrum(surface, operator, MODES + 1)
    graph = graph_of(operator, system)
    return {
        "mesh from labels": make,
        "spectrum for shape DNA, 36 pairs": partial(surface_spectrum, surface, operator, 36),
        f"spectrum, {MODES + 1} pairs": partial(surface_spectrum, surface, operator, MODES + 1),
        f"the same by ARPACK as LaPy calls it, {MODES + 1} pairs": partial(usual_spectrum, operator, MODES + 1),
        "certificates": partial(value_radii, operator, system),
        "nodal counts": partial(counted_domains, system, graph),
        "heat quantiles": partial(heat_distribution, system, areas),
        "wave quantiles": partial(wave_distribution, system, areas),
        "GPS distances": partial(embedding_distances, system, areas),
    }


def pair_tasks() -> dict[str, list[Callable[[], object]]]:
    """Distances of all pairs of three people, by method."""
    embeddings = []
    for donor in DONORS[:3]:
        surface = subcortical_person(donor, "putamen", "left", 0)
        system = surface_spectrum(surface, fem(surface.mesh), 20)
        embeddings.append(spectral_embedding(system, surface.mesh.vertex_areas, 4))
    pairings = {"exact signs": Pairing("mean_hausdorff"), "blocks": Pairing("block_orthogonal")}
    return {
        name: [partial(pairing, *pair) for pair in combinations(embeddings, 2)] for name, pairing in pairings.items()
    }


def seconds(calls: list[Callable[[], object]]) -> float:
    """Median processor seconds of the calls, each the second time."""
    spent = []
    for call in calls:
        call()
        start = process_time()
        call()
        spent.append(process_time() - start)
    return float(np.median(spent))


def main() -> None:
    """Print the table."""
    people = [tasks(donor) for donor in DONORS[:3]]
    print(f"| step | processor seconds | hours for {COHORT:,} people |\n|---|--:|--:|")
    for name in people[0]:
        cost = seconds([person[name] for person in people])
        print(f"| {name}, a person | {cost:.3f} | {cost * COHORT / 3600:.2g} |")
    for name, calls in pair_tasks().items():
        cost = seconds(calls)
        print(f"| {name}, a pair; a query against all | {cost:.3f} | {cost * COHORT * QUERIES / 3600:.2g} |")
        print(f"| {name}, everybody against all | | {cost * COHORT**2 / 3600:.2g} |")


if __name__ == "__main__":
    main()
