"""The table of clusters of a permutation test, and its maps on the whole surface."""

from __future__ import annotations

import numpy as np

from surfexp.contract.arrays import Floats, Integers
from surfexp.inference.clusters import Clusters, clusters_where
from surfexp.inference.corrections import false_discovery_rate, family_wise
from surfexp.inference.permutation_inference import NullDistributions, Statistics
from surfexp.mesh.both_hemispheres import side_of
from surfexp.mesh.label_map import LabelMap
from surfexp.mesh.surface import Surface
from surfexp.mesh.surface_part import SurfacePart
from surfexp.tasks.tested_maps import PermutationTest, TestedCluster


def tested_maps(
    owner: Surface,
    part: SurfacePart,
    statistics: Statistics,
    found: NullDistributions,
    level: float,
    parcels: LabelMap | None,
    facts: dict[str, object],
    advice: str,
) -> PermutationTest:
    """Return the result of a permutation test on the whole surface.

    Parameters
    ----------
    owner : Surface
    part : SurfacePart
        On which the test was made.
    statistics : Statistics
    found : NullDistributions
    level : float
        Of regions.
    parcels : LabelMap or None
    facts : dict
        With "least p" and "rearrangements".
    advice : str
        What makes the least p smaller.

    Returns
    -------
    PermutationTest
    """
    p_t = family_wise(statistics.size(found.t), found.largest["t"])
    p_tfce = family_wise(statistics.size(found.tfce), found.largest["tfce"])
    clusters = statistics.clusters(found.t)
    of_clusters = {
        name: family_wise(sizes, found.largest[name])
        for name, sizes in (("extent", clusters.areas), ("mass", clusters.masses))
    }
    at_vertices = {name: np.append(p, 1.0)[clusters.labels] for name, p in of_clusters.items()}
    regions = clusters_where(p_tfce <= level, found.t, statistics.graph)

    def listed(sets: Clusters, p: dict[str, Floats]) -> tuple[TestedCluster, ...]:
        rows = []
        for k in np.argsort(-sets.masses, kind="stable"):
            inside = np.flatnonzero(sets.labels == k)
            peak = int(part.vertices[sets.peaks[k]])
            x, y, z = owner.mesh.vertices[peak].tolist()
            rows.append(
                TestedCluster(
                    vertices=len(inside),
                    area=float(sets.areas[k]),
                    mass=float(sets.masses[k]),
                    peak=peak,
                    place=(x, y, z),
                    t=float(found.t[sets.peaks[k]]),
                    p_t=float(p_t[inside].min()),
                    p_tfce=float(p_tfce[inside].min()),
                    hemisphere=side_of(owner, peak),
                    parcels=_shares(parcels, part.vertices[inside], statistics.graph.areas[inside]),
                    **{f"p_{name}": float(values[k]) for name, values in p.items()},
                )
            )
        return tuple(rows)

    notes = part.notes
    if float(str(facts["least p"])) > level:
        notes += (f"No p can be under {facts['least p']:.3g} with {facts['rearrangements']}: {advice}.",)
    maps = {
        "t": found.t,
        "tfce": found.tfce,
        "p_t": p_t,
        "p_tfce": p_tfce,
        "p_extent": at_vertices["extent"],
        "p_mass": at_vertices["mass"],
        "q_t": false_discovery_rate(found.p_t),
        "q_tfce": false_discovery_rate(found.p_tfce),
    }
    return PermutationTest(
        **{name: part.extend(values) for name, values in maps.items()},
        clusters=listed(clusters, of_clusters),
        regions=listed(regions, {}),
        null=found.largest,
        level=level,
        facts=facts,
        notes=notes,
    )


def _shares(parcels: LabelMap | None, vertices: Integers, areas: Floats) -> dict[str, float]:
    """Share of the area in each parcel, largest first; what has no name counts, but is not listed."""
    if parcels is None:
        return {}
    keys = parcels.keys[vertices]
    shares = {name: float(areas[keys == key].sum() / areas.sum()) for key, name in parcels.names.items()}
    return dict(sorted(((name, share) for name, share in shares.items() if share > 0.0), key=lambda item: -item[1]))
