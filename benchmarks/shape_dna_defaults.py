"""Which eigenvalues of shape DNA, weighed how, find a shape's kind: leave-one-pose-out on the generated bodies.

Run with `python benchmarks/shape_dna_defaults.py`: six kinds of articulated bodies, each in six poses.
"""

from __future__ import annotations

import numpy as np

from surfexp.arrays import Floats, Integers
from surfexp.operators.fem import fem
from surfexp.spectrum.shape_dna import shape_dna
from surfexp.spectrum.surface_spectrum import surface_spectrum
from surfexp.studies.populations.articulated import articulated_body

BODIES = ("biped", "heavy_biped", "quadruped", "long_neck", "octopod", "worm")
POSES = range(1, 7)
MODES = (10, 20, 35, 50, 100)


def retrieval(signatures: Floats, kinds: Integers, poses: Integers) -> tuple[float, float]:
    """Return 1-NN accuracy and mean average precision, shapes in the query's own pose left out."""
    distances = np.linalg.norm(signatures[:, None] - signatures[None], axis=2)
    hits, precisions = [], []
    for query in range(len(kinds)):
        others = np.flatnonzero(poses != poses[query])
        order = others[np.argsort(distances[query, others], kind="stable")]
        relevant = kinds[order] == kinds[query]
        hits.append(float(relevant[0]))
        ranks = np.flatnonzero(relevant) + 1
        precisions.append(float((np.arange(1, len(ranks) + 1) / ranks).mean()))
    return float(np.mean(hits)), float(np.mean(precisions))


def spectra(modes: int) -> tuple[list[tuple[Floats, float]], Integers, Integers]:
    """Return (values, area) of every body, its kind and its pose."""
    systems, kinds, poses = [], [], []
    for kind, body in enumerate(BODIES):
        for pose in POSES:
            surface = articulated_body(body=body, pose=pose, bending=1.0, vertices=2000)
            system = surface_spectrum(surface, fem(surface.mesh), modes + 1)
            systems.append((system.values, system.area))
            kinds.append(kind)
            poses.append(pose)
    return systems, np.array(kinds), np.array(poses)


def main() -> None:
    """Print the table."""
    systems, kinds, poses = spectra(max(MODES))
    print("normalisation  weights  modes  1-NN   mAP")
    for normalisation in ("area", "slope"):
        for reweighted in (False, True):
            for modes in MODES:
                signatures = np.array(
                    [shape_dna(values, normalisation, area, None, reweighted)[:modes] for values, area in systems]
                )
                accuracy, precision = retrieval(signatures, kinds, poses)
                weights = "1/n" if reweighted else "1"
                print(f"{normalisation:13}  {weights:7}  {modes:5}  {accuracy:.3f}  {precision:.3f}")


if __name__ == "__main__":
    main()
